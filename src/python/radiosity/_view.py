"""Pages that show lit scenes, in notebooks or as files, and plots by one call."""

from __future__ import annotations

import os
import subprocess
import tempfile
from html import escape
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from ._arrays import path_text, require
from ._core import InputError, RunError
from ._factors import FormFactors, Table
from ._light import Solution
from ._mesh import _package
from ._picture import FalseColours, displayed, render
from ._program import program


class Page:
    """A page of one HTML file that shows a lit scene in a browser, and solves it there again for other
    lamps and colours; made by view(). A notebook shows it where it is the last thing of a cell.
    """

    def __init__(self, html: str, height: int) -> None:
        self._html = html
        self._height = height

    @property
    def html(self) -> str:
        """The file, text."""
        return self._html

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the file. Errors: InputError for another ending than .html."""
        name = path_text("path", path)
        if not name.lower().endswith(".html"):
            raise InputError(f"{name}: is no name of a page; end it in .html")
        Path(name).write_text(self._html, encoding="utf8")

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{escape(self._html)}" style="width:100%;height:{self._height}px;border:0">'
                "</iframe>")

    def __repr__(self) -> str:
        return f"<Page of {len(self._html):,} characters>"


def view(light: Solution, *, height: int = 480, camera: str = "") -> Page:
    """The page of a lit scene, as `radiosity view` makes it.

    light: a Solution on a mesh. height: pixels, in a notebook. camera: as the
    command line takes it, a name or "eye=x,y,z;target=x,y,z". The program of this package makes the page.

    Errors: InputError for a solution without a mesh; RunError with the program's reason, for instance where it
    was built without pages.

    >>> F = rad.form_factors(rad.mesh(rad.load("data/cornell-box.obj"), patches=60))
    >>> page = rad.view(rad.solve(F))                         # doctest: +SKIP
    """
    require("light", light, Solution, "a Solution: rad.solve(F)")
    if not isinstance(height, int) or height < 1:
        raise InputError(f"height: is {height!r}; give pixels, 1 or more")
    if light.form_factors.mesh is None:
        raise InputError("light: its form factors are a matrix without a mesh, of which there is nothing to see")
    with tempfile.TemporaryDirectory() as folder:
        light.form_factors.save(f"{folder}/light.h5", solution=light, progress=False)
        command = [str(program()), "view", "light.h5", "-o", "page.html", "--quiet"]
        if camera:
            command += ["--camera", camera]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RunError(done.stderr.strip().removeprefix("radiosity: "))
        return Page(Path(f"{folder}/page.html").read_text(encoding="utf8"), height)


def plot(thing: Any, axes: Any = None) -> Any:
    """Draws, by matplotlib: form factors between surfaces, of a Table or FormFactors of a mesh; a picture of
    radiance, (height, width, 4) as render() makes it; FalseColours; or the picture of a Solution.

    axes: matplotlib's, to draw into; default: new ones. Returns them.

    Errors: ImportError where matplotlib is not installed; InputError for another thing.

    >>> axes = rad.plot(rad.from_csr([[0, 1], [1, 0]], area=[1, 1], names=["hot", "cold"]).table())
    >>> [label.get_text() for label in axes.get_yticklabels()]
    ['hot', 'cold']
    """
    drawn = thing.table() if isinstance(thing, FormFactors) else thing
    if isinstance(drawn, Solution):
        if drawn.form_factors.mesh is None:
            raise InputError("plot: this solution is of a matrix without a mesh; plot its radiosity yourself")
        drawn = render(drawn.form_factors.mesh, drawn)
    picture: Optional[np.ndarray] = None
    if isinstance(drawn, FalseColours):
        picture = drawn.image
    elif isinstance(drawn, np.ndarray) and drawn.ndim == 3 and drawn.shape[2] == 4:
        picture = displayed(drawn)
    elif not isinstance(drawn, Table):
        raise InputError(f"plot: is of type {type(thing).__name__}; give form factors, their table, a Solution or a "
                         "picture of render()")
    if axes is None:
        axes = _package("matplotlib.pyplot", "run `pip install matplotlib`").subplots()[1]
    if picture is not None:
        axes.imshow(picture)
        axes.set_axis_off()
    else:
        _plot_table(drawn, axes)
    return axes


def _plot_table(table: Table, axes: Any) -> None:
    shown = axes.imshow(table.factors, cmap="viridis", vmin=0)
    places = range(len(table.names))
    axes.set_xticks(places, table.names, rotation=90)
    axes.set_yticks(places, table.names)
    axes.set_xlabel("reaches")
    axes.set_ylabel("of what leaves")
    axes.figure.colorbar(shown, ax=axes, label="form factor")
