"""Radiosity by the matrix method: arrays in, scipy out.

A scene becomes patches, patches become form factors, form factors become light or heat:

>>> import radiosity as rad
>>> scene = rad.load("data/cornell-box.obj")
>>> mesh = rad.mesh(scene, patches=200)
>>> F = rad.form_factors(mesh, tolerance=1e-3)
>>> light = rad.solve(F)
>>> light.summary["status"]
'converged'
>>> image = rad.render(mesh, light, width=32)
>>> image.shape
(32, 32, 4)

Lengths are metres, areas m^2, radiosity B, irradiance H and emission (radiant exitance) W/m^2,
radiance W/m^2/sr, temperatures K. N is the number of patches. Arrays that belong to an object
(`mesh.area`, `light.radiosity`, ...) are views of its memory: read only, without a copy, and valid as
long as they are referred to, also after the object is gone.

Every long call lets other threads run and ends with KeyboardInterrupt on Ctrl-C. All but load() and
from_csr() show their progress in terminals and notebooks; `progress=False` turns that off, and a
function takes it over: it is called as progress(stage, done, total) about twenty times a second.

Errors: InputError (a ValueError) names the file or argument, the element in it and the cure;
RunError (a RuntimeError) says why a run failed.
"""

from ._core import InputError, RunError, set_threads as _set_threads, version as __version__
from ._factors import FormFactors, Table, form_factors, from_csr, view_factors_from
from ._files import Results, read
from ._foreign import from_meshio, from_pyvista, from_trimesh
from ._gather import Gathered, gather
from ._heat import Heat, RadiantTemperature, heat
from ._illuminance import Illuminance
from ._light import Solution, solve
from ._mesh import Mesh, mesh
from ._picture import FalseColours, Layers, displayed, render
from ._scene import Light, Scene, load
from ._view import Page, plot, view

__all__ = [
    "FalseColours", "FormFactors", "Gathered", "Heat", "Illuminance", "InputError", "Layers", "Light", "Mesh",
    "Page", "RadiantTemperature", "Results", "RunError", "Scene", "Solution", "Table", "__version__", "displayed",
    "form_factors", "from_csr", "from_meshio", "from_pyvista", "from_trimesh", "gather", "heat", "load", "mesh", "plot",
    "read", "render", "set_threads", "solve", "view", "view_factors_from",
]


def set_threads(threads: int) -> None:
    """Limits all later work of the process to `threads` threads; 0: all cores.

    Results do not depend on it, to the bit.

    >>> rad.set_threads(1)
    >>> rad.set_threads(0)
    """
    _set_threads(threads)
