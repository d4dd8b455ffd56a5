"""Pictures of light."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arrays import numbers, require, yes_or_no
from ._core import InputError
from ._factors import FormFactors
from ._gather import Gathered
from ._heat import Heat
from ._light import Solution
from ._mesh import Mesh
from ._progress import Progress, reporting


class FalseColours(NamedTuple):
    """A picture of the light in a unit; made by render() with `show`."""

    values: np.ndarray  # (height, width) float64; NaN where nothing is
    image: np.ndarray  # (more, width, 4) float32, 0 to 1, sRGB: false colours and lines, the legend below


class Layers(NamedTuple):
    """A picture and what it is made of; made by render() with `layers`."""

    image: np.ndarray  # (height, width, 4) float32, W/m^2/sr
    #: (height, width, channels) float32 by name: depth (m, infinite where nothing is), normal (3, 0 there),
    #: patch, surface (numbers, -1 there), albedo (3), direct and indirect (3, W/m^2/sr: their sum is the
    #: picture times its alpha)
    layers: Dict[str, np.ndarray]


def render(mesh: Mesh, light: Any, width: Optional[int] = None, height: Optional[int] = None, *,
           camera: Any = None, samples: int = 4, smooth: bool = True, crease: float = 30.0,
           show_backs: bool = False, elements: Optional[bool] = None,
           element_tolerance: Optional[float] = None, show: Optional[str] = None,
           range: Optional[Sequence[float]] = None, layers: bool = False,
           progress: Progress = None) -> Union[np.ndarray, FalseColours, Layers]:
    """The picture of a Solution, of Heat or Gathered light, or of radiosities (N,) or (N, 3), W/m^2:
    (height, width, 4) float32.

    Red, green and blue are radiance, W/m^2/sr, linear; alpha is the share of samples that hit
    something. displayed() makes it ready to be shown. width, height: pixels, 512 by default; a side
    that is left out follows from the camera. camera: a name of the scene's, a text
    "eye=x,y,z;target=x,y,z;fov=DEGREES", or a dict as in Scene.cameras; default: the scene's first,
    else one that shows what is lit. elements: light is evaluated anew, finer than patches, at what
    the picture shows (default: of a Solution; slower, and what the command line draws); False: of the
    patches alone. No copy of the picture is made.

    show: "illuminance" (lx, on surfaces as they face, of a Solution), "luminance" (cd/m^2) or
    "radiance" (W/m^2/sr); the result is FalseColours then, its colours of `range`, (low, high), or of
    the values in view. layers: the result is Layers.

    Errors: InputError naming the option or the camera, and for light of 2 or more than 3 bands.

    >>> mesh = rad.mesh(rad.load("data/cornell-box.obj"), patches=100)
    >>> light = rad.solve(rad.form_factors(mesh))
    >>> image = rad.render(mesh, light, width=16, elements=False)
    >>> image.shape, image.dtype
    ((16, 16, 4), dtype('float32'))
    >>> rad.render(mesh, light, width=16, elements=False, show="illuminance").values.shape
    (16, 16)
    """
    require("mesh", mesh, Mesh, "a Mesh: rad.mesh(scene)")
    handle = None
    if isinstance(light, Solution):
        if light.form_factors.mesh is None or light.form_factors.mesh._handle is not mesh._handle:
            raise InputError("light: is a solution on another mesh; give the mesh of its form factors")
        handle, values = light._handle, light._handle.radiosity
    else:
        if elements:
            raise InputError("elements: need a Solution, which knows the materials; give what solve() "
                             "returned")
        if isinstance(light, FormFactors):
            raise InputError("light: is of type FormFactors; give a Solution, rad.solve(F), or "
                             "radiosities of the patches")
        given = light.radiosity if isinstance(light, (Gathered, Heat)) else light
        values = numbers("light", given, [(len(mesh),), (len(mesh), 1), (len(mesh), 3)],
                         f"N = {len(mesh)}")
        values = values.reshape(len(mesh), -1)
    options = dict(width=width, height=height, samples=samples, smooth=smooth, crease=crease,
                   show_backs=show_backs, elements=elements and smooth if handle is None else
                   (smooth if elements is None else elements),
                   element_tolerance=element_tolerance)
    drawn = (mesh._handle, handle, values, camera, options)
    if yes_or_no("layers", layers):
        if show is not None:
            raise InputError("layers: are of the lit picture; leave out show")
        with reporting(progress) as report:
            return Layers(*_core.render_layers(*drawn, report))
    if show is None:
        if range is not None:
            raise InputError("range: is of false colours; give show, or leave it out")
        with reporting(progress) as report:
            return _core.render(*drawn, report)
    require("show", show, str, "text: illuminance, luminance or radiance")
    ends = None
    if range is not None:
        low, high = numbers("range", range, [(2,)], "low, high").tolist()
        if not low < high:
            raise InputError(f"range: is {low}, {high}; give two rising numbers")
        ends = (low, high)
    with reporting(progress) as report:
        return FalseColours(*_core.render_shown(*drawn, show, ends, report))


def displayed(image: np.ndarray, exposure: Optional[float] = None) -> np.ndarray:
    """A picture of radiance as screens show it: (height, width, 4) float32 from 0 to 1, sRGB.

    exposure: stops; radiance is multiplied by 2 to the power of it. Default: automatic, as the
    command line exposes a PNG. The result is a new array; a float32 picture is not copied for it.

    >>> import numpy as np
    >>> grey = np.full((2, 2, 4), [0.5, 0.5, 0.5, 1.0], dtype=np.float32)
    >>> round(float(rad.displayed(grey, exposure=0)[0, 0, 0]), 4)
    0.7354
    """
    picture = np.ascontiguousarray(numbers("image", image, [(None, None, 4)]), dtype=np.float32)
    if exposure is not None and not abs(float(numbers("exposure", exposure, [()]))) <= 120:
        raise InputError(f"exposure: is {exposure}; give stops, -120 to 120")
    stops = _core.exposure(picture) if exposure is None else float(exposure)
    linear = np.clip(picture[..., :3] * np.float32(2.0**stops), 0, 1)
    coded = np.where(linear <= 0.0031308, 12.92 * linear,
                     1.055 * np.power(linear, 1 / 2.4, dtype=np.float32) - 0.055)
    return np.concatenate([coded, picture[..., 3:]], axis=-1).astype(np.float32)
