"""What is repaired or doubtful is said as it happens."""

from __future__ import annotations

import warnings
from typing import Iterable


def tell(notes: Iterable[dict]) -> None:
    """A UserWarning for each note that is more than information, at the line that called."""
    for note in notes:
        if note["severity"] != "info":
            warnings.warn(note["text"], UserWarning, stacklevel=3)
