"""Progress of long calls: a line in terminals and notebooks, or a function of the caller's."""

from __future__ import annotations

import os
import sys
import time
from contextlib import contextmanager, nullcontext
from typing import Callable, ContextManager, Iterator, Optional, Union

Report = Callable[[str, int, int, str], None]
#: None: shown if somebody can see it; True and False: always, never; or a function that is called
#: as progress(stage, done, total) about twenty times a second.
Progress = Union[None, bool, Callable[[str, int, int], None]]

SHOWN_AFTER = 0.5  # seconds: shorter calls leave no trace
BETWEEN = 0.2  # seconds between two lines


class _Line:
    """One line on standard error that is written over."""

    def __init__(self) -> None:
        self.start = time.monotonic()
        self.next = self.start + SHOWN_AFTER
        self.width = 0

    def __call__(self, stage: str, done: int, total: int, steps: str) -> None:
        now = time.monotonic()
        if now < self.next:
            return
        self.next = now + BETWEEN
        share = f"{100 * done // total}%" if total else ""
        count = f" ({done:,} of {total:,} {steps})" if steps and total else ""
        self.write(" ".join(filter(None, [stage, share + count])) + f", {now - self.start:.0f} s")

    def write(self, text: str) -> None:
        text = text[:_columns() - 1]  # a longer line could not be written over
        sys.stderr.write("\r" + text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)

    def clear(self) -> None:
        if self.width:
            self.write("")
            sys.stderr.write("\r")
            sys.stderr.flush()


def _columns() -> int:
    try:
        return os.get_terminal_size(sys.stderr.fileno()).columns or 80
    except (OSError, ValueError):  # no terminal, or a notebook's stream
        return 80


def _someone_looks() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())


@contextmanager
def _shown() -> Iterator[Report]:
    line = _Line()
    try:
        yield line
    finally:
        line.clear()


_SILENT: ContextManager[None] = nullcontext()


def reporting(progress: Progress) -> ContextManager[Optional[Report]]:
    """What a long call of the extension module reports to."""
    if callable(progress):
        told = progress
        return nullcontext(lambda stage, done, total, steps: told(stage, done, total))
    if progress is False or (progress is None and not _someone_looks()):
        return _SILENT
    return _shown()
