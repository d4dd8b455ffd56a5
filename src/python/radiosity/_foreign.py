"""Scenes of meshio, trimesh and pyvista, which read dozens of formats. None is imported: what they
made is looked at."""

from __future__ import annotations

from typing import Any, List, Mapping, Optional, Tuple

import numpy as np

from . import _core
from ._arrays import numbers
from ._core import InputError
from ._notes import warn
from ._scene import Scene

#: meshio's cells that are faces, and the number of points that are corners
_FACES = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}
#: The types of faces begin so, also of those that are not read.
_SURFACES = ("triangle", "quad", "polygon", "VTK_LAGRANGE_TRIANGLE", "VTK_LAGRANGE_QUADRILATERAL")
#: The same for cells that are volumes; corners come first, in VTK's order.
_VOLUMES = {"tetra": 4, "tetra10": 4, "pyramid": 5, "pyramid13": 5, "pyramid14": 5, "wedge": 6,
            "wedge15": 6, "wedge18": 6, "hexahedron": 8, "hexahedron20": 8, "hexahedron24": 8,
            "hexahedron27": 8}


def from_meshio(mesh: Any, materials: Optional[Mapping[Any, Mapping[str, Any]]] = None,
                sky: Any = 0.0) -> Scene:
    """A scene of a meshio.Mesh: its triangles, quadrilaterals and polygons, as Scene() takes them.

    Groups are its cell sets, else its physical groups (gmsh), else one. A face of no set is in the
    group "other". Of a mesh of volumes alone, the sides that no two of them share are the faces, each
    in its volume's group; a UserWarning says so. Else volumes are left out, as lines and points are.
    All arrays are copied.

    Errors: InputError for a mesh without faces and volumes.

    >>> import meshio
    >>> square = meshio.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ...                      [("quad", [[0, 1, 2, 3]])], cell_sets={"floor": [[0]]})
    >>> rad.from_meshio(square).surface_names
    ['floor']
    """
    if not hasattr(mesh, "cells") or not hasattr(mesh, "points"):
        raise InputError(f"mesh: is of type {type(mesh).__name__}; give a meshio.Mesh")
    points = numbers("points", mesh.points, [(None, 2), (None, 3)], "coordinates")
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    faces, groups = _cells(mesh, {**_FACES, "polygon": None})
    lost = sorted({block.type for block in mesh.cells if block.type.startswith(_SURFACES)} - {*_FACES, "polygon"})
    if lost:
        warn(f"meshio mesh: left out {', '.join(lost)}, which are not read")
    if not faces:
        volumes, volume_groups = _cells(mesh, _VOLUMES)
        faces, groups = _skin(points, volumes, volume_groups)
        if faces:
            warn(f"meshio mesh: no faces, volume cells alone ({len(volumes)}): the sides that no two of "
                 f"them share are the surfaces ({len(faces)})")
    if not faces:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise InputError(f"meshio mesh: has no faces but {kinds}; extract its surface first")
    if len({len(face) for face in faces}) == 1:
        return Scene(points, np.asarray(faces), groups, materials, sky)
    return Scene(points, faces, groups, materials, sky)


def _cells(mesh: Any, corners: Mapping[str, Optional[int]]) -> Tuple[list, List[str]]:
    """Corners and group of each cell of the given types; None: all its points are corners."""
    cells: list = []
    groups: List[str] = []
    for number, block in enumerate(mesh.cells):
        if block.type in corners:
            cells.extend(cell[:corners[block.type]] for cell in block.data)
            groups.extend(_groups(mesh, number, len(block.data)))
    return cells, groups


def _skin(points: np.ndarray, volumes: list, groups: List[str]) -> Tuple[list, List[str]]:
    """Faces of the skin of volumes, and the group of each."""
    if not volumes:
        return [], []
    corners = np.concatenate(volumes)
    offset = np.cumsum([0] + [len(volume) for volume in volumes]).astype(np.uint64)
    wrong = np.flatnonzero((corners < 0) | (corners >= len(points)))
    if len(wrong):
        cell = np.searchsorted(offset, wrong[0], side="right") - 1
        raise InputError(f"meshio mesh: volume cell {cell} has point {corners[wrong[0]]}; there are "
                         f"{len(points)} points, numbered from 0")
    loops, begin, of_volume = _core.volume_skin(points, corners.astype(np.uint32), offset)
    faces = np.split(loops, begin[1:-1].astype(np.int64)) if len(of_volume) else []
    return faces, [groups[k] for k in of_volume]


def _groups(mesh: Any, block: int, count: int) -> list:
    """A name a cell of one block."""
    sets = {name: cells[block] for name, cells in (mesh.cell_sets or {}).items()
            if not name.startswith("gmsh:") and cells[block] is not None}
    if sets:
        names = ["other"] * count
        for name, cells in sets.items():
            for cell in np.asarray(cells, dtype=np.int64).reshape(-1):
                if not 0 <= cell < count:
                    raise InputError(f"meshio mesh: cell set {name!r} has cell {cell} of block {block}, "
                                     f"which has {count}, numbered from 0")
                names[cell] = name
        return names
    tags = (mesh.cell_data or {}).get("gmsh:physical")
    if tags is None:
        return ["surface"] * count
    named = {int(value[0]): name for name, value in (mesh.field_data or {}).items()}
    return [named.get(int(tag), f"physical {tag}") for tag in tags[block]]


def from_trimesh(mesh: Any, materials: Optional[Mapping[Any, Mapping[str, Any]]] = None,
                 sky: Any = 0.0) -> Scene:
    """A scene of a trimesh.Trimesh, one group, or of a trimesh.Scene, whose geometries are groups in
    the place where its graph puts them. All arrays are copied.

    Errors: InputError for one without faces.
    """
    if not hasattr(mesh, "geometry") and not hasattr(mesh, "faces"):
        raise InputError(f"mesh: is of type {type(mesh).__name__}; give a trimesh.Trimesh or Scene")
    if hasattr(mesh, "geometry"):
        parts = []
        for node in mesh.graph.nodes_geometry:
            transform, name = mesh.graph[node]
            part = mesh.geometry[name].copy()
            part.apply_transform(transform)
            parts.append((str(node), part))
    else:
        parts = [("surface", mesh)]
    parts = [(name, part) for name, part in parts if len(getattr(part, "faces", ()))]
    if not parts:
        raise InputError("trimesh: has no faces; give a Trimesh, or a Scene of some")
    first = np.cumsum([0] + [len(part.vertices) for _, part in parts])
    return Scene(np.concatenate([np.asarray(part.vertices) for _, part in parts]),
                 np.concatenate([np.asarray(part.faces) + k for k, (_, part) in zip(first, parts)]),
                 np.repeat([name for name, _ in parts], [len(part.faces) for _, part in parts]),
                 materials, sky)


def from_pyvista(mesh: Any, groups: Optional[str] = None,
                 materials: Optional[Mapping[Any, Mapping[str, Any]]] = None, sky: Any = 0.0) -> Scene:
    """A scene of a pyvista.PolyData: its polygons, as Scene() takes them. All arrays are copied.

    groups: the name of an array of its cells, whose values are the groups; of several parts join them first, or
    take `mesh.extract_surface()` of other data sets. Default: one group.

    Errors: InputError for one without polygons, for strips, lines and points beside them, and for an array that is
    not there.

    >>> class Square:                # as pyvista.Plane(), which need not be installed
    ...     points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    ...     faces = [4, 0, 1, 2, 3]
    ...     n_cells = 1
    ...     cell_data = {"room": ["floor"]}
    >>> rad.from_pyvista(Square(), groups="room").surface_names
    ['floor']
    """
    if not hasattr(mesh, "faces") or not hasattr(mesh, "points") or not hasattr(mesh, "cell_data"):
        raise InputError(f"mesh: is of type {type(mesh).__name__}; give a pyvista.PolyData, of other data sets "
                         "mesh.extract_surface()")
    padded = np.asarray(mesh.faces, dtype=np.int64).reshape(-1)
    faces: list = []
    at = 0
    while at < len(padded):
        faces.append(padded[at + 1:at + 1 + padded[at]])
        at += 1 + int(padded[at])
    if not faces:
        raise InputError("pyvista mesh: has no polygons; extract its surface first")
    if mesh.n_cells != len(faces):
        raise InputError(f"pyvista mesh: {mesh.n_cells - len(faces)} of its {mesh.n_cells} cells are no polygons; "
                         "take mesh.triangulate(), without lines and points")
    of_faces = None
    if groups is not None:
        if groups not in mesh.cell_data:
            raise InputError(f"groups: there is no array {groups!r} of cells; there are: "
                             f"{', '.join(mesh.cell_data.keys()) or 'none'}")
        of_faces = np.asarray(mesh.cell_data[groups])
    return Scene(np.asarray(mesh.points, dtype=np.float64), faces, of_faces, materials, sky)
