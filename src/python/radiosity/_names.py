"""Surfaces by the names that people give them."""

from __future__ import annotations

from typing import List, Sequence

from ._arrays import printable
from ._core import InputError


def surfaces_named(names: Sequence[str], wanted: str) -> List[int]:
    """The surfaces ("object/material", or the one name that both have) that a name stands for: a
    surface, else all of a material, else all of an object, as on the command line."""
    parts = [name.rpartition("/") for name in names]
    for known in (names, [material for _, _, material in parts], [thing for thing, _, _ in parts]):
        found = [k for k, name in enumerate(known) if name == wanted]
        if found:
            return found
    raise InputError(printable(f"{wanted}: no surface, material or object is called so; surfaces are: "
                               f"{', '.join(names)}"))
