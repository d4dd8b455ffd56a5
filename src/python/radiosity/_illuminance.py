"""Light at measuring points."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional, Tuple

import numpy as np

from . import _core
from ._arrays import numbers
from ._progress import Progress, reporting

_LUMENS = 683  # a watt of luminance
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear Rec. 709


class Illuminance(NamedTuple):
    """Light at P points; made by Solution.illuminance().

    Irradiance has the shape of a patch's values behind P: (P,) or (P, bands), or (P, bands, k) of k
    lamps. Lux are of three bands (683 lm/W times their luminance, Rec. 709) or of one (grey: 683
    times its value); for others they are None.
    """

    total: np.ndarray  # W/m^2, on a small surface that faces along the normal
    direct: np.ndarray  # W/m^2, of it from emitters and lamps
    indirect: np.ndarray  # W/m^2, of it from all else
    lux: Optional[np.ndarray]  # (P,)
    direct_lux: Optional[np.ndarray]  # (P,)
    indirect_lux: Optional[np.ndarray]  # (P,)
    cube_lux: Optional[np.ndarray]  # (P, 6): on surfaces that face +x, -x, +y, -y, +z, -z
    cylindrical_lux: Optional[np.ndarray]  # (P,), EN 12464-1
    daylight_factor: Optional[np.ndarray]  # (P,), percent of open level ground; None: not skies alone,
    #                                        or one with a sun in it
    error: np.ndarray  # (P,): standard error of the rays over `total`
    in_body: np.ndarray  # (P,), bool: most that the point sees are black backs


def _lux(values: np.ndarray) -> Optional[np.ndarray]:
    """Of irradiance whose last axis are the bands."""
    if values.shape[-1] == 3:
        return _LUMENS * (values @ _LUMINANCE)
    return _LUMENS * values[..., 0] if values.shape[-1] == 1 else None


def measured(light: "_core.Solution", bands: Tuple[int, ...], points: Any, normals: Any, options: dict,
             progress: Progress) -> Illuminance:
    """`bands`: the shape of a patch's values."""
    places = numbers("points", points, [(None, 3)])
    ways = None
    if normals is not None:
        ways = numbers("normals", normals, [(len(places), 3), (3,)])
        ways = np.ascontiguousarray(np.broadcast_to(ways, places.shape))
    with reporting(progress) as report:
        found = _core.illuminance(light, places, ways, options, report)
    direct, indirect = found["direct"], found["indirect"]
    total = direct + indirect
    shape = (len(places), *bands)
    lux = [None if len(bands) == 2 else _lux(values) for values in (total, direct, indirect)]
    facing = [None if values is None else values[:, 0] for values in lux]
    cube = None if lux[0] is None else lux[0][:, 1:7]
    cylinder = None if lux[0] is None else lux[0][:, 7]
    outside = found["open_lux"]
    daylight = 100 * facing[0] / outside if facing[0] is not None and outside > 0 else None
    return Illuminance(total[:, 0].reshape(shape), direct[:, 0].reshape(shape), indirect[:, 0].reshape(shape),
                       facing[0], facing[1], facing[2], cube, cylinder, daylight,
                       found["error"], found["inside"].astype(bool))
