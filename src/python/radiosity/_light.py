"""Light: B = E + rho (F B + pi sky F_sky)."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Tuple

import numpy as np

from . import _core
from ._arrays import Fixed, numbers, require
from ._core import InputError, RunError
from ._factors import FormFactors
from ._html import figure, summary
from ._illuminance import Illuminance, measured
from ._mesh import Mesh
from ._notes import warn
from ._options import more, takes_options
from ._progress import Progress, reporting


class Solution(Fixed):
    """Radiosities of N patches, or of the rows of a matrix from elsewhere; made by solve().

    Values have the shape of the emission that they are of: (N,), (N, bands) or (N, bands, k).
    """

    def __init__(self, handle: "_core.Solution", form_factors: FormFactors,
                 shape: Optional[Tuple[int, ...]] = None) -> None:
        self._handle = handle
        self._form_factors = form_factors
        self._shape = shape or handle.radiosity.shape

    @property
    def radiosity(self) -> np.ndarray:
        """B, float64, W/m^2: what leaves each patch; a view."""
        return self._handle.radiosity.reshape(self._shape)

    @property
    def irradiance(self) -> np.ndarray:
        """H, float64, W/m^2: what falls on each patch; a view."""
        return self._handle.irradiance.reshape(self._shape)

    @property
    def emission(self) -> np.ndarray:
        """E, float64, W/m^2, as it was solved for; a view."""
        return self._handle.emission.reshape(self._shape)

    @property
    def reflectance(self) -> np.ndarray:
        """rho, float64, 0 to 1, as it was solved for; a view."""
        return self._handle.reflectance.reshape(self._shape)

    @property
    def summary(self) -> dict:
        """What the solver did, a dict: status (converged, no_convergence or no_light), usable,
        message, solver, iterations, rows (of the matrix that were used), skipped (a dict: rows of
        black_patches, dark_bands, equal_bands), residual and residual_history
        (relative to the largest emission), error_bound (W/m^2, of |B - B*|; None: unknown), energy
        (lists by band, W: emitted, from_sky, absorbed, to_sky, on_backs, imbalance), seconds.

        Not converging is no error but a warning: `usable` is False then.
        """
        return self._handle.summary

    @property
    def form_factors(self) -> FormFactors:
        """The form factors that it was solved on."""
        return self._form_factors

    @takes_options("illuminance")
    def illuminance(self, points: Any, normals: Any = None, *, progress: Progress = None,
                    **others: Any) -> Illuminance:
        """Light at P points anywhere in the scene, W/m^2 a band and lux.

        points: (P, 3), metres. normals: the way that each faces, (P, 3), of any length but 0, or (3,)
        for all; default: up. Direct light of surfaces and points is exact, but by rays past much that
        hides it; that of suns, and of photometric lamps near by, is by 16 to 1,024 rays. The rest is by
        rays, as many as the tolerance takes. The error of each point, as it faces, is told.

        Errors: InputError naming the point or the normal.

        >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24), tolerance=1e-6)
        >>> light = rad.solve(F, reflectance=0.5, emission=[1.0] * 24, tolerance=1e-9)
        >>> middle = light.form_factors.mesh.vertices.mean(axis=0)
        >>> found = light.illuminance([middle])
        >>> found.total.shape, float(found.total[0].round(6)), float(found.lux[0].round(3))  # 683 lm/W
        ((1,), 2.0, 1366.0)
        """
        if self.form_factors.mesh is None:
            raise InputError("illuminance: these form factors are a matrix without a mesh; use those of "
                             "form_factors(mesh)")
        return measured(self._handle, self._shape[1:], points, normals, more("illuminance", others), progress)

    def __repr__(self) -> str:
        return f"<Solution of shape {self._shape}, {self.summary['status']}>"

    def _repr_html_(self) -> str:
        title = f"{repr(self).strip('<>')}, residual {self.summary['residual']:.2g}"
        mesh = self.form_factors.mesh
        area = self.form_factors.area
        names = ["all rows"] if mesh is None else mesh.surface_names
        surface = np.zeros(len(area), dtype=int) if mesh is None else mesh.surface
        total = np.maximum(np.bincount(surface, area, minlength=len(names)), 1e-300)
        means = [np.bincount(surface, area * values.reshape(len(area), -1).mean(axis=1), minlength=len(names)) / total
                 for values in (self.radiosity, self.irradiance)]
        return summary(title, ["surface", "radiosity, W/m^2", "irradiance, W/m^2"],
                       ([name, figure(B), figure(H)] for name, B, H in zip(names, *means)))


class Materials(NamedTuple):
    """Reflectance and emission of each row in every band, and the sky's radiance by band."""

    reflectance: np.ndarray
    emission: np.ndarray
    sky: Optional[list]  # None: the lights of the scene
    shape: Tuple[int, ...]  # of the given emission


def _emission(mesh: Optional[Mesh], rows: int, meaning: str, given: Any) -> np.ndarray:
    """What is given, else the scene's."""
    if given is None:
        if mesh is None:
            raise InputError(f"emission: these form factors have no scene; give it, shape ({rows},), "
                             f"({rows}, bands) or ({rows}, bands, k)")
        return mesh.emission
    E = numbers("emission", given, [(rows,), (rows, None), (rows, None, None)], meaning)
    if 0 in E.shape[1:]:
        raise InputError(f"emission: has shape {E.shape}; give at least one band")
    return E


def _reflectance(mesh: Optional[Mesh], rows: int, bands: int, meaning: str, given: Any) -> np.ndarray:
    """(rows, bands) of what is given, else the scene's."""
    if given is None:
        if mesh is None or bands != 3:
            raise InputError(f"reflectance: the scene's has 3 bands, emission has {bands}; give one "
                             f"number, ({rows},) or ({rows}, {bands})")
        return mesh.reflectance
    rho = numbers("reflectance", given, [(), (rows,), (rows, bands)], meaning)
    return np.broadcast_to(rho.reshape(rows, 1) if rho.ndim == 1 else rho, (rows, bands))


def _sky(given: Any, bands: int, lamps: int) -> list:
    """Its radiance in each band of each lamp; empty where it is dark."""
    if given is None:
        return []
    radiance = numbers("sky", given, [(), (bands,)], "one number, or one a band")
    return np.repeat(np.broadcast_to(radiance, (bands,)), lamps).tolist()


def materials_of(mesh: Optional[Mesh], rows: int, meaning: str, reflectance: Any, emission: Any,
                 sky: Any) -> Materials:
    """What is given of the light on `rows` rows; the rest is the scene's."""
    E = _emission(mesh, rows, meaning, emission)
    bands = 1 if E.ndim == 1 else E.shape[1]
    lamps = E.shape[2] if E.ndim == 3 else 1
    rho = _reflectance(mesh, rows, bands, meaning, reflectance)
    if lamps > 1:
        rho = np.repeat(rho, lamps, axis=1)
    if mesh is not None and emission is None and sky is None:
        shine = None
    else:
        shine = _sky(sky, bands, lamps)
    return Materials(np.ascontiguousarray(rho), E.reshape(rows, bands * lamps), shine, E.shape)


@takes_options("solve")
def solve(F: FormFactors, reflectance: Any = None, emission: Any = None, *, sky: Any = None,
          solver: str = "auto", tolerance: float = 1e-6, max_iterations: int = 10000,
          progress: Progress = None, **others: Any) -> Solution:
    """Solves for the light on N patches (or rows of a matrix), every band in one pass.

    emission: radiant exitance, W/m^2, (N,), (N, bands) or, for k lamps at once, (N, bands, k);
    default: the scene's, with its sky. reflectance: 0 to 1, one number, (N,) or (N, bands); default:
    the scene's, of 3 bands. sky: radiance, W/m^2/sr, one number or (bands,); default: dark where
    emission is given. solver: auto, jacobi, gauss-seidel, cg, gmres or direct (petsc runs under mpirun
    alone). tolerance: of the true residual, relative to the largest emission of a band.

    Arrays are copied once, as float64; those of the result are views of new ones. A UserWarning says
    where the iterations did not converge.

    Errors: InputError naming the argument and the patch; RunError for a closed room that reflects all
    light.

    >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24), tolerance=1e-6)
    >>> light = rad.solve(F, reflectance=0.5, emission=[1.0] * 24, tolerance=1e-9)
    >>> light.radiosity.shape, float(light.radiosity.mean().round(3))  # E / (1 - rho)
    ((24,), 2.0)
    """
    require("F", F, FormFactors, "form factors: rad.form_factors(mesh)")
    materials = shape = None
    if F.mesh is None or reflectance is not None or emission is not None or sky is not None:
        rows = len(F) if F.mesh is None else len(F.mesh)
        given = materials_of(F.mesh, rows, f"N = {len(F)}", reflectance, emission, sky)
        materials, shape = (given.reflectance, given.emission, given.sky), given.shape
    else:
        F.mesh._require_scene()
    options = dict(solver=solver, tolerance=tolerance, max_iterations=max_iterations, **more("solve", others))
    with reporting(progress) as report:
        handle = _core.solve(F._handle, materials, options, report)
    if not handle.usable:
        summary = handle.summary
        if summary["status"] == "singular":
            raise RunError(summary["message"])
        warn(summary["message"])
    return Solution(handle, F, shape)
