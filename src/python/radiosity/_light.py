"""Light: B = E + rho (F B + pi sky F_sky)."""

from __future__ import annotations

from typing import Any, Optional, Tuple

import numpy as np

from . import _core
from ._arrays import numbers
from ._core import InputError, RunError
from ._factors import FormFactors
from ._progress import Progress, reporting


class Solution:
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
        """status, usable, solver, iterations, residual, error_bound, energy (W by band), message, ...

        Not converging is no error: look at `usable`.
        """
        return self._handle.summary

    @property
    def form_factors(self) -> FormFactors:
        """The form factors that it was solved on."""
        return self._form_factors

    def __repr__(self) -> str:
        return f"<Solution of shape {self._shape}, {self.summary['status']}>"


def _light_of_scene(F: FormFactors, sky: Any) -> tuple:
    if F.mesh is None:
        raise InputError(f"emission: these form factors have no scene; give it, shape ({len(F)},), "
                         f"({len(F)}, bands) or ({len(F)}, bands, k)")
    return F.mesh.emission, F.mesh._handle.sky if sky is None else sky


def solve(F: FormFactors, reflectance: Any = None, emission: Any = None, *, sky: Any = None,
          solver: str = "auto", tolerance: float = 1e-6, max_iterations: int = 10000,
          progress: Progress = None) -> Solution:
    """Solves for the light on N patches (or rows of a matrix), every band in one pass.

    emission: radiant exitance, W/m^2, (N,), (N, bands) or, for k lamps at once, (N, bands, k);
    default: the scene's, with its sky. reflectance: 0 to 1, one number, (N,) or (N, bands); default:
    the scene's, of 3 bands. sky: radiance, W/m^2/sr, one number or (bands,); default: dark where
    emission is given. solver: auto, jacobi, gauss-seidel, cg, gmres or direct. tolerance: of the true
    residual, relative to the largest emission of a band.

    Arrays are copied once, as float64. Errors: InputError naming the argument and the patch.

    >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24), tolerance=1e-6)
    >>> light = rad.solve(F, reflectance=0.5, emission=[1.0] * 24, tolerance=1e-9)
    >>> light.radiosity.shape, float(light.radiosity.mean().round(3))  # E / (1 - rho)
    ((24,), 2.0)
    """
    rows = len(F) if F.mesh is None else len(F.mesh)
    if emission is None:
        emission, sky = _light_of_scene(F, sky)
    E = numbers("emission", emission, [(rows,), (rows, None), (rows, None, None)], f"N = {rows}")
    shape = E.shape
    bands = 1 if E.ndim == 1 else shape[1]
    lamps = shape[2] if E.ndim == 3 else 1
    if bands * lamps < 1:
        raise InputError(f"emission: has shape {shape}; give at least one band")
    if reflectance is None:
        if F.mesh is None or bands != 3:
            raise InputError(f"reflectance: the scene's has 3 bands, emission has {bands}; give one "
                             f"number, ({rows},) or ({rows}, {bands})")
        reflectance = F.mesh.reflectance
    rho = numbers("reflectance", reflectance, [(), (rows,), (rows, bands)], f"N = {rows}")
    rho = rho.reshape(rows, 1) if rho.ndim == 1 else rho
    rho = np.broadcast_to(rho, (rows, bands))
    rho = rho if lamps == 1 else np.repeat(rho, lamps, axis=1)
    shine = [] if sky is None or len(np.atleast_1d(sky)) == 0 else np.repeat(
        np.broadcast_to(numbers("sky", sky, [(), (bands,)]), (bands,)), lamps).tolist()
    options = dict(solver=solver, tolerance=float(tolerance), max_iterations=max_iterations)
    with reporting(progress) as report:
        handle = _core.solve(F._handle, np.ascontiguousarray(rho), E.reshape(rows, bands * lamps),
                             shine, options, report)
    if handle.summary["status"] == "singular":
        raise RunError(handle.summary["message"])
    return Solution(handle, F, shape)
