"""Meshes: the scene cut into patches."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Mapping, Optional

import numpy as np

from . import _core
from ._arrays import Fixed, numbers, require
from ._core import InputError
from ._html import figure, summary
from ._names import surfaces_named
from ._notes import tell
from ._options import more, takes_options
from ._progress import Progress, reporting
from ._scene import Scene


def _package(name: str, cure: str) -> Any:
    try:
        return import_module(name)
    except ImportError:
        raise ImportError(f"{name} is not installed; {cure}", name=name) from None


class Mesh(Fixed):
    """N patches, planar polygons, each of one surface; made by mesh().

    Fronts come first, then the backs of two-sided patches.
    """

    def __init__(self, handle: "_core.Mesh") -> None:
        self._handle = handle

    def __len__(self) -> int:
        return len(self._handle.area)

    @property
    def vertices(self) -> np.ndarray:
        """(V, 3) float64, metres; a view."""
        return self._handle.vertices

    @property
    def corners(self) -> np.ndarray:
        """uint32 vertices of all outlines, one patch after the other, counter-clockwise seen from
        the patch's side; a view. See corner_offset."""
        return self._handle.corners

    @property
    def corner_offset(self) -> np.ndarray:
        """(N + 1,) uint64: corners of patch i are corners[corner_offset[i]:corner_offset[i + 1]]; a view."""
        return self._handle.corner_offset

    @property
    def triangles(self) -> np.ndarray:
        """(T, 3) uint32 vertices of triangles that tile the patches; a view. See triangle_offset."""
        return self._handle.pieces

    @property
    def triangle_offset(self) -> np.ndarray:
        """(N + 1,) uint64: triangles of patch i are triangles[triangle_offset[i]:triangle_offset[i + 1]];
        a view."""
        return self._handle.piece_offset

    @property
    def centroid(self) -> np.ndarray:
        """(N, 3) float64, metres; a view."""
        return self._handle.centroid

    @property
    def normal(self) -> np.ndarray:
        """(N, 3) float64, unit, out of the patch's side; 0 where it is degenerate; a view."""
        return self._handle.normal

    @property
    def area(self) -> np.ndarray:
        """(N,) float64, m^2; a view.

        >>> mesh = rad.mesh(rad.load("data/furnace-cube.obj"), patches=24)
        >>> float(mesh.area.sum().round(9))
        6.0
        """
        return self._handle.area

    @property
    def surface(self) -> np.ndarray:
        """(N,) uint32, into surface_names; a view."""
        return self._handle.surface

    @property
    def surface_names(self) -> list:
        """Names of the surfaces, as Scene.surface_names."""
        return self._handle.surface_names

    @property
    def source_face(self) -> np.ndarray:
        """(N,) uint32: the face of the scene that each patch is of; a view."""
        return self._handle.source_face

    @property
    def side(self) -> np.ndarray:
        """(N,) uint8: 0 front, 1 back; a view."""
        return self._handle.side

    @property
    def reflectance(self) -> np.ndarray:
        """(N, 3) float64, 0 to 1: the scene's, textures averaged over the patch; a view."""
        self._require_scene()
        return self._handle.reflectance

    @property
    def emission(self) -> np.ndarray:
        """(N, 3) float64, radiant exitance, W/m^2: the scene's; a view."""
        self._require_scene()
        return self._handle.emission

    @property
    def scene(self) -> Optional[Scene]:
        """The scene that was meshed; None in a results file without one."""
        handle = self._handle.scene
        return None if handle is None else Scene._of(handle)

    @property
    def report(self) -> dict:
        """What meshing did, a dict: surfaces (a dict each: name, and areas given, kept, buried,
        overlapped, degenerate, m^2); counts of repairs (welded_vertices, degenerate_faces,
        duplicate_faces, nonplanar_faces, hidden_sides, cuts, split_edges) and of what is left
        (t_junctions, crossings, nonmanifold_edges); polygons, triangles, quads;
        largest_deviation, longest_edge (m), smallest_angle, widest_cone (degrees);
        smallest_angle_surface; notes: a dict of severity and text each."""
        return self._handle.report

    def per_patch(self, by_name: Mapping[str, Any], other: Any = 0.0) -> np.ndarray:
        """Values by the name of a surface, material or object as an array (N,), or (N, bands) where
        values have bands: a new array.

        `other`: of the surfaces that are not named. A later name replaces what an earlier one says.
        Errors: InputError for a name that is not there, with those that are.

        >>> mesh = rad.mesh(rad.load("data/cornell-box.obj"), patches=100)
        >>> mesh.per_patch({"lamp": 10.0}).max()
        10.0
        """
        require("by_name", by_name, Mapping, "a dict by the name of a surface, material or object")
        names = self.surface_names
        values = [numbers("other", other, [(), (None,)])] * len(names)
        for name, value in by_name.items():
            given = numbers(f"value of {name!r}", value, [(), (None,)])
            for k in surfaces_named(names, name):
                values[k] = given
        try:
            table = np.stack(np.broadcast_arrays(*values))
        except ValueError:
            raise InputError("values have different numbers of bands; give each as many") from None
        return table[self.surface]

    def to_meshio(self, **fields: Any) -> Any:
        """A meshio.Mesh of the triangles, with `fields` ((N,) or (N, bands)) as their data.

        Its points are a view, all else is a copy. Errors: ImportError where meshio is not installed,
        with the cure.

        >>> mesh = rad.mesh(rad.load("data/furnace-cube.obj"), patches=24)
        >>> sorted(mesh.to_meshio(area=mesh.area).cell_data)
        ['area', 'surface']
        """
        meshio = _package("meshio", "install Debian's python3-meshio, or run `pip install meshio`")
        data = {name: [values] for name, values in self._of_triangles(fields).items()}
        return meshio.Mesh(self.vertices, [("triangle", self.triangles.astype(np.int64))],
                           cell_data=data)

    def to_pyvista(self, **fields: Any) -> Any:
        """A pyvista.PolyData of the triangles, with `fields` ((N,) or (N, bands)) as their data.

        All arrays are copies. Errors: ImportError where pyvista is not installed, with the cure.
        """
        pyvista = _package("pyvista", "run `pip install pyvista`")
        faces = np.insert(self.triangles.astype(np.int64), 0, 3, axis=1)
        poly = pyvista.PolyData(np.array(self.vertices), faces.reshape(-1))
        for name, values in self._of_triangles(fields).items():
            poly.cell_data[name] = values
        return poly

    def _of_triangles(self, fields: Mapping[str, Any]) -> dict:
        each = np.diff(self.triangle_offset.astype(np.int64))
        shapes = [(len(self),), (len(self), None)]
        data = {name: np.repeat(numbers(name, values, shapes, nan=True), each, axis=0)
                for name, values in fields.items()}
        data["surface"] = np.repeat(self.surface, each)
        return data

    def _require_scene(self) -> None:
        if not self._handle.has_scene:
            raise InputError("the mesh is of a results file without a scene; give materials as arrays")

    def __repr__(self) -> str:
        return f"<Mesh of {len(self):,} patches on {len(self.surface_names)} surfaces>"

    def _repr_html_(self) -> str:
        names = self.surface_names
        counts = np.bincount(self.surface, minlength=len(names))
        areas = np.bincount(self.surface, self.area, minlength=len(names))
        return summary(repr(self).strip("<>"), ["surface", "patches", "area, m^2"],
                       ([name, f"{n:,}", figure(area)] for name, n, area in zip(names, counts, areas)))


@takes_options("mesh")
def mesh(scene: Scene, patches: int = 2000, *, max_edge: float = 0.0, weld: float = 1e-7,
         faces_as_patches: bool = False, progress: Progress = None, **others: Any) -> Mesh:
    """Cuts the scene into about `patches` patches.

    max_edge: metres, the longest patch edge (0: derived from `patches`). weld: coincidence, as a
    fraction of the scene's diagonal. faces_as_patches: patch k is face k of the scene; nothing is
    welded, cut or re-ordered. The same options give the same mesh as on the command line. The
    scene is kept, not copied; the mesh's arrays are views of new ones.

    Errors: InputError for options out of range and a scene without area.

    >>> rad.mesh(rad.load("data/furnace-cube.obj"), patches=24)
    <Mesh of 24 patches on 6 surfaces>
    """
    require("scene", scene, Scene, "a Scene: rad.load(path) or rad.Scene(...)")
    options = dict(patches=patches, max_edge=max_edge, weld=weld, faces_as_patches=faces_as_patches,
                   **more("mesh", others))
    with reporting(progress) as report:
        mesh = Mesh(_core.mesh(scene._handle, options, report))
    tell(mesh.report["notes"])
    return mesh
