"""What is repaired or doubtful is said as it happens."""

from __future__ import annotations

import warnings
from typing import Iterable


def warn(text: str) -> None:
    """A UserWarning at the line that called the function that calls this."""
    warnings.warn(text, UserWarning, stacklevel=3)


def tell(notes: Iterable[dict]) -> None:
    """A UserWarning for each note that is more than information, as warn()."""
    for note in notes:
        if note["severity"] != "info":
            warnings.warn(note["text"], UserWarning, stacklevel=3)
