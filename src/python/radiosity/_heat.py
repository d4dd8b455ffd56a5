"""Radiative heat exchange on the same form factors."""

from __future__ import annotations

import os
from typing import Any, List, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _core
from ._arrays import Fixed, numbers, path_text, require, texts, yes_or_no
from ._core import InputError
from ._factors import FormFactors
from ._notes import warn
from ._options import more, takes_options
from ._progress import Progress, reporting

#: One value for all surfaces, or values by name.
ByName = Union[float, Mapping[str, Any]]


class RadiantTemperature(NamedTuple):
    """What a person at P points feels of the surroundings, K; made by Heat.radiant_temperature()."""

    standing: np.ndarray  # (P,): mean radiant temperature of ISO 7726, by the six faces of a small cube
    seated: np.ndarray  # (P,)
    plane: np.ndarray  # (P, 6): of each face, which look to +x, -x, +y, -y, +z, -z
    surfaces: np.ndarray  # (P,): the share of what the cube sees that are fronts of surfaces


class Heat(Fixed):
    """Temperatures and fluxes of N patches, or of the rows of a matrix; made by heat()."""

    def __init__(self, handle: "_core.Heat", form_factors: FormFactors) -> None:
        self._handle = handle
        self._form_factors = form_factors

    @property
    def temperature(self) -> np.ndarray:
        """(N,) float64, K; NaN where nothing determines it; a view."""
        return self._handle.temperature

    @property
    def net_flux(self) -> np.ndarray:
        """(N,) float64, W/m^2: net radiation, above 0 where a patch gives off heat; a view."""
        return self._handle.net_flux

    @property
    def convection(self) -> np.ndarray:
        """(N,) float64, W/m^2: given off to the air; a view."""
        return self._handle.convection

    @property
    def radiosity(self) -> np.ndarray:
        """(N, bands) float64, W/m^2: what leaves each patch; a view."""
        return self._handle.radiosity

    @property
    def irradiance(self) -> np.ndarray:
        """(N, bands) float64, W/m^2: what falls on each patch; a view."""
        return self._handle.irradiance

    @property
    def summary(self) -> dict:
        """What the solver did, a dict: status, usable, message, iterations (of Newton's method),
        linear_steps, residual and balance_residual (relative), undetermined (patches without a
        temperature), balance (a dict, W: radiated, to_sky, on_backs, imbalance, convected, throughput),
        seconds, notes (dicts of severity and text, on groups that overlap). Not converging is no error but a warning: `usable` is False then."""
        return self._handle.summary

    @property
    def form_factors(self) -> FormFactors:
        """The form factors that heat was exchanged on."""
        return self._form_factors

    def table(self) -> List[dict]:
        """A dict a surface, or a name of a matrix's rows: name, area (m^2), temperature (its mean),
        lowest, highest (K), radiosity, irradiance, irradiance_error (None: unknown), net_flux (W/m^2),
        radiated, convected (W)."""
        return _core.heat_table(self._handle)

    def radiant_temperature(self, points: Any, *, sky_temperature: Optional[float] = None,
                            progress: Progress = None) -> RadiantTemperature:
        """The radiant temperature of surfaces and sky at points, (P, 3), metres: that of uniform black
        surroundings which send as much heat.

        sky_temperature: K; default: that of heat(). Errors: InputError naming the point, and for heat that was
        read without it.

        >>> F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24), tolerance=1e-6)
        >>> oven = rad.heat(F, emissivity=0.9, temperature=400)
        >>> middle = F.mesh.vertices.mean(axis=0)
        >>> float(oven.radiant_temperature([middle]).standing[0].round(3))  # all around is as hot
        400.0
        """
        if self.form_factors.mesh is None:
            raise InputError("radiant_temperature: these form factors are a matrix without a mesh; use those of "
                             "form_factors(mesh)")
        places = numbers("points", points, [(None, 3)])
        sky = None if sky_temperature is None else float(numbers("sky_temperature", sky_temperature, [()]))
        with reporting(progress) as report:
            return RadiantTemperature(*_core.radiant_temperature(self._handle, places, sky, report))

    def __repr__(self) -> str:
        return f"<Heat of {len(self.temperature):,} rows, {self.summary['status']}>"


def _number(name: str, value: Any) -> str:
    return repr(float(numbers(name, value, [()])))


def _emissivity(name: str, value: Any) -> str:
    """One number, one a band, a table {K: emissivity} or the word "material", as text."""
    if isinstance(value, str) and value == "material":
        return value
    bands = value if isinstance(value, (list, tuple, np.ndarray)) and np.ndim(value) else [value]
    of_bands = []
    for band in bands:
        if isinstance(band, Mapping):
            values = {float(numbers(f"{name}, a temperature", T, [()])): eps for T, eps in band.items()}
            of_bands.append(" ".join(f"{T!r}:{_number(name, values[T])}" for T in sorted(values)))
        else:
            of_bands.append(_number(name, band))
    return "; ".join(of_bands)


def _by_name(value: Optional[ByName]) -> dict:
    if value is None:
        return {}
    return dict(value) if isinstance(value, Mapping) else {"*": value}


def _settings(given: Mapping[str, Optional[ByName]]) -> List[str]:
    """The conditions as "NAME.PROPERTY=VALUE", first those of all that others leave out."""
    by_property = {name: _by_name(value) for name, value in given.items()}
    heated = {name for kind in ("temperature", "flux", "power", "convection")
              for name, value in by_property[kind].items() if value is not None}
    lines = []
    for kind, values in by_property.items():
        for name, value in values.items():
            if value is None:
                if kind != "temperature":
                    raise InputError(f"{kind} of {name!r}: is None; leave it out")
                if name not in heated:
                    lines.append((name, f"{name}.flux=0"))
            elif kind == "emissivity":
                lines.append((name, f"{name}.emissivity={_emissivity(f'emissivity of {name!r}', value)}"))
            elif kind == "isothermal":
                lines.append((name, f"{name}.isothermal="
                                    f"{'yes' if yes_or_no(f'isothermal of {name!r}', value) else 'no'}"))
            else:
                lines.append((name, f"{name}.{kind}={_number(f'{kind} of {name!r}', value)}"))
    return [text for name, text in sorted(lines, key=lambda pair: pair[0] != "*")]


def _of_rows(F: FormFactors, name: str, value: Optional[Any], other: float) -> np.ndarray:
    """A value a row, of one number, an array, or numbers by the rows' names (* for all others)."""
    if not isinstance(value, Mapping):
        given = numbers(name, other if value is None else value, [(), (len(F),)], "one a row", nan=True)
        return np.ascontiguousarray(np.broadcast_to(given, (len(F),)))
    names = F._handle.names
    other = value.get("*", other)
    for known in value:
        if known != "*" and known not in names:
            raise InputError(f"{name} of {known!r}: no row is called so; there are: "
                             f"{', '.join(dict.fromkeys(names)) or 'none'}")
    of_rows = [value.get(row, other) for row in names]
    return numbers(name, [np.nan if v is None else v for v in of_rows], [(len(F),)], nan=True)


@takes_options("heat")
def heat(F: FormFactors, emissivity: Any = None, temperature: Any = None, *, flux: Any = None,
         power: Any = None, convection: Any = None, ambient: Any = None, isothermal: Any = None,
         table: Union[None, str, "os.PathLike[str]"] = None,
         groups: Union[str, Sequence[str]] = (), sky_temperature: float = 0.0,
         band_edges: Sequence[float] = (), band_fractions: Sequence[float] = (),
         tolerance: float = 1e-9, max_iterations: int = 100, progress: Progress = None, **others: Any) -> Heat:
    """Exchanges heat by radiation, with what each surface is given.

    Each condition is a dict by the name of a surface, material or object, or one value for all that
    no other names: emissivity (0 to 1; a list: one a band; a dict {K: emissivity}: a table; "material":
    1 - reflectance),
    temperature (K; None: to be found, adiabatic unless flux, power or convection says more), flux
    (W/m^2 supplied), power (W supplied), convection (W/m^2/K) to air of `ambient` (K), isothermal
    (bool). The name "*" is all surfaces that no other names. table: a CSV file of the same.
    groups: "NAME=PATTERN", one or a list, as in FormFactors.table(); conditions may name them, and
    Heat.table() has one row for each.
    band_edges: micrometres. Nothing is guessed: a surface without emissivity or condition is an error.
    A UserWarning says where the iterations did not converge.

    Of a matrix from elsewhere: the same by the rows' names, or emissivity, temperature and flux alone
    as arrays of one a row, (rows,), NaN where not given.

    What is given is copied; the arrays of the result are views of new ones. Errors: InputError naming
    the surface and the cure.

    >>> F = rad.from_csr([[0, 1], [1, 0]], area=[1, 1], names=["hot", "cold"])
    >>> plates = rad.heat(F, {"hot": 0.8, "cold": 0.5}, {"hot": 1000, "cold": 500})
    >>> float(plates.net_flux[0].round(6))  # sigma (1000^4 - 500^4) / (1/.8 + 1/.5 - 1)
    23626.56008

    >>> F = rad.form_factors(rad.mesh(rad.load("data/cornell-box-closed.obj"), patches=60))
    >>> oven = rad.heat(F, emissivity=0.8, temperature={"lamp": 1200, "floor": 300, "*": None})
    >>> oven.summary["status"]
    'converged'
    """
    require("F", F, FormFactors, "form factors: rad.form_factors(mesh)")
    options = dict(sky_temperature=sky_temperature, tolerance=tolerance,
                   max_iterations=max_iterations,
                   band_edges=numbers("band_edges", band_edges, [(None,)]).tolist(),
                   band_fractions=numbers("band_fractions", band_fractions, [(None,)]).tolist(),
                   **more("heat", others))
    conditions = dict(emissivity=emissivity, temperature=temperature, flux=flux, power=power,
                      convection=convection, ambient=ambient, isothermal=isothermal)
    by = _heat_of_rows if F.mesh is None and _has_arrays(conditions) else _heat_by_name
    found = by(F, conditions, table, texts("groups", groups), options, progress)
    summary = found.summary
    if not summary["usable"]:
        warn(summary["message"])
    return found


def _heat_by_name(F: FormFactors, given: dict, table: Any, groups: List[str], options: dict,
                  progress: Progress) -> Heat:
    if F.mesh is not None:
        _refuse_arrays(given, len(options["band_fractions"]) or len(options["band_edges"]) + 1)
    settings = _settings(given)
    if not settings and table is None:
        raise InputError("heat: no conditions are given; give emissivity and temperature (or flux, "
                         "power, convection) by name, or table=FILE.csv")
    path = "" if table is None else path_text("table", table)
    with reporting(progress) as report:
        return Heat(_core.heat(F._handle, path, settings, groups, options, report), F)


def _has_arrays(conditions: dict) -> bool:
    return any(not isinstance(value, Mapping) and np.ndim(value) for value in conditions.values())


def _refuse_arrays(conditions: dict, bands: int) -> None:
    """Surfaces of a mesh have conditions by name, and an emissivity may be one a band."""
    for name, value in conditions.items():
        if value is None or isinstance(value, Mapping) or not np.ndim(value):
            continue
        if name != "emissivity":
            raise InputError(f"{name}: is an array; give one number, or a dict by surface name")
        if len(value) not in (1, bands):
            raise InputError(f"emissivity: has {len(value)} values; give one number, {bands} (one a "
                             "band), or a dict by surface name")


def _heat_of_rows(F: FormFactors, given: dict, table: Any, groups: List[str], options: dict,
                  progress: Progress) -> Heat:
    refused = [name for name in ("power", "convection", "ambient", "isothermal")
               if given[name] is not None]
    refused += ["table"] * (table is not None) + ["groups"] * bool(groups)
    if refused:
        raise InputError(f"{refused[0]}: does not go with arrays of one a row; give all conditions by "
                         "the rows' names")
    if given["emissivity"] is None:
        raise InputError(f"emissivity: give one number, one a row ({len(F)},), or a dict by name")
    eps, T, q = (_of_rows(F, name, given[name], np.nan) for name in ("emissivity", "temperature", "flux"))
    missing = np.flatnonzero(np.isnan(eps))
    if len(missing):
        raise InputError(f"emissivity: row {missing[0]} has none; give it")
    with reporting(progress) as report:
        return Heat(_core.heat_of_rows(F._handle, eps, T, q, options, report), F)
