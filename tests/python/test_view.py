"""Summaries, pages and plots."""

import re
import types
from html.parser import HTMLParser

import numpy as np
import pytest

import radiosity as rad
from conftest import box


class Cells(HTMLParser):
    """The rows of a table, and whether all tags are closed in turn."""

    def __init__(self, html):
        super().__init__()
        self.open, self.rows = [], []
        self.feed(html)
        assert not self.open, self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.open[-1] in ("td", "th"):
            self.rows[-1][-1] += data


def room(lamp="lamp"):
    vertices, faces = box()
    return rad.Scene(vertices, [f[::-1] for f in faces], [lamp] + ["walls"] * 5,
                     {lamp: {"emission": 100, "reflectance": 0}, "walls": {"reflectance": 0.5}})


def test_summaries_have_the_figures_of_what_they_sum_up():
    scene = room()
    mesh = rad.mesh(scene, patches=54)
    F = rad.form_factors(mesh, tolerance=1e-6)
    light = rad.solve(F)
    assert [[row[0], *row[2:]] for row in Cells(scene._repr_html_()).rows[1:]] == [
        ["lamp", "0", "100", "1"], ["walls", "0.5", "0", "1"]]
    assert "background:#bcbcbc" in scene._repr_html_()  # sRGB of .5
    assert Cells(mesh._repr_html_()).rows[1:] == [["lamp", "9", "1"], ["walls", "45", "5"]]
    factors = dict(Cells(F._repr_html_()).rows[1:])
    assert float(factors["reaches patches"]) == pytest.approx(1, abs=1e-3)
    rows = {row[0]: row[1:] for row in Cells(light._repr_html_()).rows[1:]}
    # All that the lamp sends, 100 W, is absorbed by the lamp and 5 m^2 of walls: 1 H_lamp + 2.5 H_walls.
    assert float(rows["lamp"][0]) == 100
    assert float(rows["lamp"][1]) + 2.5 * float(rows["walls"][1]) == pytest.approx(100, rel=1e-3)
    assert "converged" in light._repr_html_()


def test_summaries_escape_names_and_say_what_they_leave_out():
    html = room("<b>&")._repr_html_()
    assert "<b>&" not in html.replace("<p><b>", "") and "&lt;b&gt;&amp;" in html
    vertices, faces = box()
    many = rad.Scene(np.concatenate([vertices + 3 * k for k in range(4)]),
                     [[c + 8 * k for c in f] for k in range(4) for f in faces], [f"g{k}" for k in range(24)])
    assert len(Cells(many._repr_html_()).rows) == 13 and "and 12 more" in many._repr_html_()


def test_a_matrix_without_a_mesh_sums_up():
    F = rad.from_csr([[0, 1], [1, 0]], area=[1, 1])
    assert Cells(F._repr_html_()).rows[1][1] == "1"
    light = rad.solve(F, reflectance=0.5, emission=[1.0, 0.0])
    # B_1 = 1 + B_2 / 2, B_2 = B_1 / 2: 4/3 and 2/3.
    assert Cells(light._repr_html_()).rows[1] == ["all rows", "1", "1"]
    with pytest.raises(rad.InputError, match="without a mesh"):
        rad.view(light)
    with pytest.raises(rad.InputError, match="without a mesh"):
        rad.plot(light)


def test_a_page_shows_the_solution(tmp_path):
    light = rad.solve(rad.form_factors(rad.mesh(room(), patches=54)))
    try:
        page = rad.view(light, height=300)
    except rad.RunError as error:
        pytest.skip(str(error))  # built without node
    assert page.html.lstrip().lower().startswith("<!doctype html>")
    frame = page._repr_html_()
    assert re.match(r'<iframe srcdoc="[^"]*" style="[^"]*height:300px[^"]*"></iframe>$', frame, re.DOTALL)
    page.save(tmp_path / "room.html")
    assert (tmp_path / "room.html").read_text() == page.html
    with pytest.raises(rad.InputError, match=r"end it in \.html"):
        page.save(tmp_path / "room.htm")
    with pytest.raises(rad.RunError, match="no camera 'nowhere'"):
        rad.view(light, camera="nowhere")
    with pytest.raises(rad.InputError, match="height"):
        rad.view(light, height=0)


def test_plots(cornell):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = rad.plot(cornell)
    np.testing.assert_array_equal(axes.images[0].get_array(), cornell.table().factors)
    light = rad.solve(cornell)
    image = rad.render(cornell.mesh, light, width=16, elements=False)
    np.testing.assert_array_equal(rad.plot(image).images[0].get_array(), rad.displayed(image))
    again = rad.plot(image, axes)
    assert again is axes and len(axes.images) == 2
    shown = rad.render(cornell.mesh, light, width=16, elements=False, show="illuminance")
    np.testing.assert_array_equal(rad.plot(shown).images[0].get_array(), shown.image)
    with pytest.raises(rad.InputError, match="plot: is of type str"):
        rad.plot("cornell")


def polydata(**more):
    vertices, faces = box()
    given = {"points": vertices, "faces": np.concatenate([[4, *f] for f in faces]), "n_cells": 6,
             "cell_data": {"room": np.array(["a", "a", "b", "b", "b", "b"])}}
    return types.SimpleNamespace(**{**given, **more})


def test_pyvista_polygons_become_a_scene():
    scene = rad.from_pyvista(polydata(), groups="room", materials={"b": {"emission": 2}})
    assert scene.surface_names == ["a", "b"]
    assert rad.mesh(scene, patches=24).area.sum() == pytest.approx(6, rel=1e-12)
    mixed = polydata(faces=np.array([4, 0, 1, 3, 2, 3, 4, 6, 7]), n_cells=2)
    assert list(rad.from_pyvista(mixed).face_offset) == [0, 4, 7]
    for wrong, words in [(polydata(faces=np.zeros(0, int)), "no polygons"), (polydata(n_cells=8), "2 of its 8 cells"),
                         ("mesh", "of type str")]:
        with pytest.raises(rad.InputError, match=words):
            rad.from_pyvista(wrong)
    with pytest.raises(rad.InputError, match="no array 'x' of cells; there are: room"):
        rad.from_pyvista(polydata(), groups="x")
