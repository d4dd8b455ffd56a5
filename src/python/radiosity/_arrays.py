"""Checks of what callers give, with one line on what is wrong and what would be right."""

from __future__ import annotations

import os
from typing import Any, List, Optional, Sequence

import numpy as np

from ._core import InputError


def require(name: str, value: Any, kind: type, cure: str) -> None:
    """InputError unless `value` is of the type; `cure` says what to give."""
    if not isinstance(value, kind):
        raise InputError(f"{name}: is of type {type(value).__name__}; give {cure}")


def texts(name: str, value: Any) -> List[str]:
    """A list of texts; one text is a list of itself."""
    try:
        given = [value] if isinstance(value, str) else list(value)
    except TypeError:
        raise InputError(f"{name}: is of type {type(value).__name__}; give texts") from None
    for text in given:
        require(name, text, str, "texts")
    return given


def path_text(name: str, value: Any) -> str:
    """The path of a file, as text."""
    try:
        path = os.fsdecode(value)
    except TypeError:
        raise InputError(f"{name}: is of type {type(value).__name__}; give the path of a file") from None
    if not path or "\0" in path:
        raise InputError(f"{name}: is {path!r}; give the path of a file")
    return path


def printable(text: str) -> str:
    """`text` with bytes of a file that are not of UTF-8 as "\\xdf"."""
    return text.encode("utf-8", "surrogateescape").decode("utf-8", "backslashreplace")


def yes_or_no(name: str, value: Any) -> bool:
    """InputError unless it is True or False, of Python or numpy."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name}: is {value!r}; give True or False")
    return bool(value)


class Fixed:
    """An object that does not change once it is made: copies of it are itself."""

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, known: dict) -> Any:
        return self

    def __reduce__(self) -> Any:
        raise TypeError(f"{type(self).__name__} cannot be pickled; keep it in a results file: "
                        "form_factors.save(path, ...), read(path)")


def _shape_text(shape: Sequence[Any]) -> str:
    return "(" + ", ".join("any" if n is None else str(n) for n in shape) + ("," if len(shape) == 1 else "") + ")"


def _require_shape(name: str, array: np.ndarray, shapes: Sequence[Sequence[Optional[int]]],
                   meaning: str) -> None:
    for shape in shapes:
        if len(shape) == array.ndim and all(n is None or n == m for n, m in zip(shape, array.shape)):
            return
    wanted = " or ".join(_shape_text(shape) for shape in shapes)
    raise InputError(f"{name}: has shape {array.shape}; give {wanted}{meaning and ': ' + meaning}")


def numbers(name: str, value: Any, shapes: Sequence[Sequence[Optional[int]]], meaning: str = "",
            nan: bool = False) -> np.ndarray:
    """`value` as contiguous float64 of one of the shapes (None: any length), finite unless `nan`."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise InputError(f"{name}: has masked entries; fill them (value.filled(...)) or leave them out")
    try:
        given = np.asarray(value)
    except ValueError as error:
        raise InputError(f"{name}: is no array of numbers: {error}") from None
    if given.dtype.kind == "O" and not given.ndim:
        raise InputError(f"{name}: is of type {type(value).__name__}; give real numbers")
    if given.dtype.kind not in "buif":
        raise InputError(f"{name}: has dtype {given.dtype}; give real numbers"
                         f"{', NaN where there is none' if nan else ''}")
    array = np.ascontiguousarray(given, dtype=np.float64) if given.ndim else given.astype(np.float64)
    _require_shape(name, array, shapes, meaning)
    good = ~np.isinf(array) if nan else np.isfinite(array)
    if not good.all() and not array.ndim:
        raise InputError(f"{name}: is {array}; give a finite number")
    if not good.all():
        first = tuple(int(k) for k in np.argwhere(~good)[0])
        place = first[0] if len(first) == 1 else first
        raise InputError(f"{name}: entry {place} is {array[first]}; give finite numbers")
    return array


def indices(name: str, value: Any, shapes: Sequence[Sequence[Optional[int]]], below: int,
            of: str) -> np.ndarray:
    """`value` as contiguous uint32 of one of the shapes, each at least 0 and below `below`."""
    try:
        given = np.asarray(value)
    except ValueError as error:
        raise InputError(f"{name}: is no array of whole numbers: {error}") from None
    if given.dtype.kind not in "ui":
        raise InputError(f"{name}: has dtype {given.dtype}; give whole numbers, indices of {of}")
    _require_shape(name, given, shapes, "")
    if given.size and (given.min() < 0 or given.max() >= below):
        first = tuple(int(k) for k in np.argwhere((given < 0) | (given >= below))[0])
        raise InputError(f"{name}: row {first[0]} has index {given[first]}; there are {below} {of}, "
                         "numbered from 0")
    return np.ascontiguousarray(given, dtype=np.uint32)
