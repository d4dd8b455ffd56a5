"""Results files and matrices in files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Optional, Union

from . import _core
from ._arrays import path_text
from ._factors import FormFactors
from ._heat import Heat
from ._light import Solution
from ._mesh import Mesh
from ._progress import Progress, reporting
from ._scene import Scene


@dataclass(frozen=True)
class Results:
    """What a file holds; None for what it does not.

    scene: a Scene. mesh: a Mesh. form_factors: FormFactors, of a matrix in a file without a mesh.
    solution: a Solution, heat: a Heat, both on these form factors.
    """

    scene: Optional[Scene] = None
    mesh: Optional[Mesh] = None
    form_factors: Optional[FormFactors] = None
    solution: Optional[Solution] = None
    heat: Optional[Heat] = None


def read(path: Union[str, "os.PathLike[str]"], progress: Progress = None) -> Results:
    """Reads a results file (.h5) of this package or the command line, or a matrix of form factors
    alone: MatrixMarket (.mtx), View3D (.vf).

    Arrays of what was read are views of it, no copies. Reading a results file shows no
    progress.

    Errors: InputError, one line with the file and the cure.

    >>> import tempfile
    >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     F.save(f"{folder}/cube.h5")
    ...     again = rad.read(f"{folder}/cube.h5")
    >>> (again.form_factors.csr != F.csr).nnz
    0
    """
    name = path_text("path", path)
    if not _core.is_results(name):
        with reporting(progress) as report:
            return Results(form_factors=FormFactors(_core.read_matrix(name, report)))
    got = _core.read(name)
    scene = Scene._of(got["scene"]) if "scene" in got else None
    mesh = Mesh(got["mesh"]) if "mesh" in got else None
    factors = FormFactors(got["form_factors"], mesh) if "form_factors" in got else None
    return Results(scene, mesh, factors,
                   Solution(got["solution"], factors) if factors and "solution" in got else None,
                   Heat(got["heat"], factors) if factors and "heat" in got else None)
