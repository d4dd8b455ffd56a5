"""Summaries for notebooks: short tables of HTML."""

from __future__ import annotations

from html import escape
from typing import Any, Iterable, List, Sequence

import numpy as np

from ._arrays import printable

#: Rows of a table that are shown; a line says how many more there are.
_MOST = 12


def figure(value: Any) -> str:
    """Four digits; the mean of three bands."""
    return f"{float(np.mean(value)):.4g}"


def swatch(colour: Sequence[float]) -> str:
    """A reflectance, linear, as a square of that colour."""
    linear = np.clip(np.asarray(colour, dtype=float), 0, 1)
    coded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    red, green, blue = (int(x) for x in np.rint(255 * coded))
    return f'<span style="background:#{red:02x}{green:02x}{blue:02x};border:1px solid #888">&emsp;</span>'


def summary(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A title above a table. Cells are HTML already; the first column is text, which is escaped here."""
    lines: List[str] = [f"<p><b>{escape(printable(title))}</b></p>", "<table><thead><tr>",
                        *(f"<th>{escape(column)}</th>" for column in columns), "</tr></thead><tbody>"]
    given = list(rows)
    for first, *others in given[:_MOST]:
        cells = "".join(f"<td>{cell}</td>" for cell in others)
        lines.append(f"<tr><td>{escape(printable(first))}</td>{cells}</tr>")
    lines.append("</tbody></table>")
    if len(given) > _MOST:
        lines.append(f"<p>and {len(given) - _MOST:,} more</p>")
    return "".join(lines)
