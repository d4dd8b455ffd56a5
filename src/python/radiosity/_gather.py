"""Light that is gathered through hemicubes, pass by pass, without a matrix."""

from __future__ import annotations

from typing import Any, List, Optional, Tuple

import numpy as np

from . import _core
from ._arrays import Fixed, require
from ._light import materials_of
from ._mesh import Mesh
from ._notes import tell, warn
from ._options import more, takes_options
from ._progress import Progress, reporting

MOST_PASSES = 100  # unless the caller asks for fewer


class Gathered(Fixed):
    """Light that L eyes gathered, at the vertices or the patches of a mesh; made by gather().

    Values of patches have the shape of the emission that they are of: (N,), (N, bands) or
    (N, bands, k); those of eyes have L in place of N.
    """

    def __init__(self, handle: "_core.Gathered", mesh: Mesh, shape: Tuple[int, ...]) -> None:
        self._handle = handle
        self._mesh = mesh
        self._shape = shape

    @property
    def radiosity(self) -> np.ndarray:
        """B, float64, W/m^2: of each patch, its mean by area; a view."""
        return self._handle.radiosity.reshape(self._shape)

    @property
    def eye_radiosity(self) -> np.ndarray:
        """B, float32, W/m^2: at each eye; a view."""
        return self._handle.eye_radiosity.reshape((-1, *self._shape[1:]))

    @property
    def eye_irradiance(self) -> np.ndarray:
        """H, float32, W/m^2: at each eye; a view."""
        return self._handle.eye_irradiance.reshape((-1, *self._shape[1:]))

    @property
    def eye_position(self) -> np.ndarray:
        """(L, 3) float64, metres; a view."""
        return self._handle.eye_position

    @property
    def eye_of_corner(self) -> np.ndarray:
        """uint32: the eye at every entry of Mesh.corners; empty where eyes are at patches; a view."""
        return self._handle.eye_of_corner

    @property
    def passes(self) -> List[dict]:
        """A dict a pass: seconds, change, bound (W/m^2, of what later passes add; None: not known),
        energy (W by band), in_flight (W by band, still to be reflected)."""
        return self._handle.summary["passes"]

    @property
    def summary(self) -> dict:
        """What was done, a dict: status (converged, pass_limit or no_light), message, passes (a list of
        dicts), hemicubes, pixels, closed, bytes, seconds, simd_target, notes."""
        return self._handle.summary

    @property
    def notes(self) -> List[dict]:
        """What a reader of the light should know: a dict of severity and text each."""
        return self._handle.summary["notes"]

    @property
    def mesh(self) -> Mesh:
        """The mesh that it was gathered on."""
        return self._mesh

    def __repr__(self) -> str:
        summary = self.summary
        return f"<Gathered of {len(summary['passes'])} passes, {summary['status']}>"


@takes_options("gather")
def gather(mesh: Mesh, reflectance: Any = None, emission: Any = None, *, sky: Any = None,
           at: str = "vertices", passes: int = MOST_PASSES, tolerance: float = 1e-4, resolution: int = 256,
           eye: str = "cpu", seed: int = 1, crease: float = 30.0, inset: float = 0.1,
           progress: Progress = None, **others: Any) -> Gathered:
    """Gathers light on a mesh of N patches: pass k adds the k-th bounce. No matrix is stored.

    reflectance, emission, sky: as solve() takes them, by patch; default: the scene's. at: vertices
    or patches, where eyes look from. passes: at most; they end before where `tolerance`, relative to
    the largest emission, bounds what is missing. resolution: pixels along an edge of a hemicube, even,
    16 to 4096. eye: who draws hemicubes: cpu, gl or auto, as form_factors(). seed: of the turns of
    hemicubes about their normals. crease: degrees; a vertex looks once a side that bends less. inset:
    how far an eye on an edge moves away from it, a share of the distance to the next one.

    The mesh is kept, not copied; arrays are copied once, as float64. A UserWarning says where a
    hundred passes or more did not suffice. render(mesh, gathered.radiosity) draws the light. The same
    options give the same bits as on the command line.

    Errors: InputError naming the argument or the patch.

    >>> mesh = rad.mesh(rad.load("data/furnace-cube.obj"), patches=24)
    >>> light = rad.gather(mesh, 0.5, [1.0] * 24, at="patches", resolution=32)
    >>> light.summary["status"], float(light.radiosity.mean().round(3))  # E / (1 - rho)
    ('converged', 2.0)
    """
    require("mesh", mesh, Mesh, "a Mesh: rad.mesh(scene)")
    light = materials_of(mesh, len(mesh), f"N = {len(mesh)}", reflectance, emission, sky)
    options = dict(at=at, passes=passes, tolerance=tolerance, resolution=resolution, eye=eye, seed=seed,
                   crease=crease, inset=inset, **more("gather", others))
    with reporting(progress) as report:
        handle = _core.gather(mesh._handle, light.reflectance, light.emission, light.sky, options, report)
    summary = handle.summary
    tell(summary["notes"])
    if summary["status"] == "pass_limit" and passes >= MOST_PASSES:
        warn(summary["message"])
    return Gathered(handle, mesh, light.shape)
