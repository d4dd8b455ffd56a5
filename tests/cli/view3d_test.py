"""View3D input as a scene: its surfaces, emissivities and names, and each broken file with its line."""

import math
import sys
import unittest

import numpy
from scipy.io import mmread

from cli_runner import CliTest

CUBE_VERTICES = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
CUBE_FACES = [(1, 2, 3, 4), (1, 4, 8, 5), (1, 5, 6, 2), (7, 6, 5, 8), (7, 3, 2, 6), (7, 8, 4, 3)]
WALLS = ["floor", "west", "south", "ceiling", "east", "north"]


def lines(vertices, surfaces):
    """A file of F = 3: places, and the fields after the number of each surface."""
    text = "T  a room\nC  encl=1 eps=1.e-5\nF  3\n"
    for k, place in enumerate(vertices):
        text += "V {} {} {} {}\n".format(k + 1, *place)
    text += "!  #   v1  v2  v3  v4 base cmb  emit  name\n"
    for k, (letter, rest) in enumerate(surfaces):
        text += f"{letter} {k + 1} {rest}\n"
    return text + "End of data\nnot read any more\n"


def walls(emissivity=0.9):
    return [("S", "{} {} {} {} 0 0 {} {}".format(*face, emissivity, name))
            for face, name in zip(CUBE_FACES, WALLS)]


def flat(*corners):
    """Places on the floor."""
    return [(x, y, 0) for x, y in corners]


class View3d(CliTest):
    def put(self, text, name="a.vs3"):
        self.write(name, text)
        return name

    def scene(self, *options):
        return self.report("info", "a.vs3", *options)["scene"]

    def areas(self):
        return {s["name"]: round(s["area_m2"], 12) for s in self.scene()["surfaces"]}

    def factors(self, *options):
        self.run_program("factors", "a.vs3", "--tolerance", "1e-9", *options, "-o", "f.mtx")
        return mmread(self.folder / "f.mtx").toarray()

    def says(self, line, text):
        self.assertEqual(self.refuse("info", self.put(text)), "radiosity: a.vs3" + line)

    def test_a_cube_has_the_closed_form(self):
        self.put(lines(CUBE_VERTICES, walls()))
        scene = self.scene()
        self.assertEqual([s["name"] for s in scene["surfaces"]], WALLS)
        self.assertEqual(scene["watertight"], True)
        # Opposite sides of a cube (Howell, configuration C-11 with a = b = c): the manual of View3D
        # gives 0.199824896.
        opposite = 2 / math.pi * (math.log(2 / math.sqrt(3)) + math.sqrt(8) * math.atan(1 / math.sqrt(2))
                                  - 2 * math.atan(1))
        self.assertAlmostEqual(opposite, 0.199824896, 9)
        found = self.factors("--faces-as-patches")
        expected = numpy.full((6, 6), (1 - opposite) / 4)
        for a, b in [(0, 3), (1, 4), (2, 5)]:
            expected[a, b] = expected[b, a] = opposite
        numpy.fill_diagonal(expected, 0)
        # Closed forms keep the tolerance.
        numpy.testing.assert_allclose(found, expected, atol=1e-9)

    def test_emissivity_is_one_less_the_reflectance(self):
        self.put(lines(CUBE_VERTICES, walls(0.9)[:5] + walls("1")[5:]))
        materials = {m["name"]: m["reflectance"] for m in self.scene()["materials"]}
        self.assertEqual(materials["floor"].split(",")[0], "0.1")
        self.assertEqual(materials["north"], "0, 0, 0")

    def test_the_front_is_where_vertices_go_counter_clockwise(self):
        # Two unit squares that face each other at distance 1, and the same turned away.
        for order, value in [((5, 8, 7, 6), 0.199824896), ((5, 6, 7, 8), 0)]:
            self.put(lines(CUBE_VERTICES, [("S", "1 2 3 4 0 0 .9 a"),
                                           ("S", "{} {} {} {} 0 0 .9 b".format(*order))]))
            self.assertAlmostEqual(self.factors("--faces-as-patches")[0, 1], value, 9)

    def test_subsurfaces_are_cut_out_of_their_base(self):
        # A window in the floor, a pane in the window, and a door that touches an edge and a corner.
        more = flat((.25, .25), (.5, .25), (.5, .75), (.25, .75), (.3, .3), (.4, .3), (.35, .5),
                    (.6, 0), (1, 0), (1, .4), (.6, .4))
        self.put(lines(CUBE_VERTICES + more, walls() + [
            ("S", "9 10 11 12 1 0 .8 window"), ("S", "13 14 15 0 7 0 .1 pane"),
            ("S", "16 17 18 19 1 0 .5 door")]))
        areas = self.areas()
        self.assertEqual([areas[n] for n in ["floor", "window", "pane", "door"]],
                         [1 - .125 - .16, .125 - .01, .01, .16])
        self.assertNotIn("overlap", self.run_program("info", "a.vs3").err)
        # Nothing overlaps and nothing is missing: every row of the closed room sums to 1.
        found = self.factors("--patches", "60")
        # Rows are good to the tolerance, which is relative to the mean form factor, and are stored
        # in single precision if that suffices.
        numpy.testing.assert_allclose(found.sum(axis=1), 1, atol=1e-6)

    def test_combined_surfaces_are_one(self):
        half = [(0.5, 0, 0), (0.5, 1, 0)]
        self.put(lines(CUBE_VERTICES + half, [("S", "1 9 10 4 0 0 .9 floor")] + walls()[1:] + [
            ("S", "9 2 3 10 0 1 .9 floor-b")]))
        scene = self.scene()
        self.assertEqual([(s["name"], s["faces"]) for s in scene["surfaces"]],
                         [("floor", 2)] + [(w, 1) for w in WALLS[1:]])
        self.assertEqual(self.areas()["floor"], 1)

    def test_obstructions_block_under_a_name_of_their_own(self):
        between = [(x, y, .5) for x, y in ((0, 0), (0, 1), (1, 1), (1, 0))]
        squares = [("S", "1 2 3 4 0 0 .9 a"), ("S", "7 6 5 8 0 0 .9 b")]
        for row, name in [("9 10 11 12", "obstruction 3"), ("9 10 11 12 0 0 1 screen", "screen")]:
            self.put(lines(CUBE_VERTICES + between, squares + [("O", row)]))
            scene = self.scene()
            self.assertEqual([s["name"] for s in scene["surfaces"]], ["a", "b", name])
            self.assertEqual(scene["materials"][2]["reflectance"], "0, 0, 0")
            self.assertIn(f"obstruction surfaces block and absorb (reflectance 0): {name}",
                          self.run_program("info", "a.vs3").out)
            self.assertEqual(self.factors("--faces-as-patches")[0, 1], 0)

    def test_null_and_mask_surfaces_take_their_part_of_the_base(self):
        for letter in "NM":
            more = flat((.25, .25), (.25, .75), (.75, .75), (.75, .25))
            self.put(lines(CUBE_VERTICES + more, walls() + [(letter, "9 10 11 12 1 0 .9 rug")]))
            self.assertEqual(self.areas()["floor"], 0.75)
            self.assertIn("mask and null surfaces see nothing but what they cover: both are left out: rug",
                          self.run_program("info", "a.vs3").err)

    def test_surfaces_placed_by_azimuth_and_tilt_are_the_same_scene(self):
        self.put(lines(CUBE_VERTICES, walls()))
        expected = self.factors("--faces-as-patches")
        placed = ["0 0 0 180 0", "0 0 0 90 90", "1 0 0 0 90", "1 0 1 0 180", "1 1 0 270 90",
                  "0 1 0 180 90"]
        shapes = ["R"] * 5 + ["Q"]
        text = "F 3a\n"
        for k, (place, shape, name) in enumerate(zip(placed, shapes, WALLS)):
            size = "1 1" if shape == "R" else "0 0  1 0  1 1\n 0 1"
            text += f"S {k + 1} {shape} 0 0 .9 {name}\n  {place}  {size}\n"
        self.put(text)
        scene = self.scene()
        self.assertEqual([s["name"] for s in scene["surfaces"]], WALLS)
        self.assertEqual(scene["watertight"], True)  # corners meet to the bit
        self.assertEqual([scene["lower_m"], scene["upper_m"]], [[0, 0, 0], [1, 1, 1]])
        numpy.testing.assert_allclose(self.factors("--faces-as-patches"), expected, atol=1e-9)

    def test_names_are_unique_and_keywords_ignore_case(self):
        two = [("S", "1 2 3 4 0 0 .9 wall"), ("S", "7 6 5 8 0 0 .5 wall"),
               ("S", "1 4 8 5 0 0 .5 north wall")]
        self.put(lines(CUBE_VERTICES, two).lower().replace("\n", "\r\n"), "a.V3D")
        run = self.run_program("info", "a.V3D", "--set", "wall#2.reflectance=.25", "--unit", "cm")
        self.assertIn("wall#2: reflectance 0.5 -> 0.25", run.out)
        self.assertIn("words behind the name of a surface are left out: `wall` in line 15", run.err)
        self.assertIn("View3D controls are not used (options of the program say these): encl=1, eps=1.e-5",
                      run.out)

    def test_broken_files_are_refused_by_line(self):
        text = lines(CUBE_VERTICES, walls())
        for old, new, line in [
                ("V 2 1", "V 2 nan", ":5: coordinate `nan` is not a finite number; write it as 1.5 with a "
                                     "decimal point"),
                ("V 2 1", "V 3 1", ":5: vertex 3 stands where vertex 2 belongs; number them in order"),
                ("S 2 1", "S 4 1", ":14: surface 4 stands where surface 2 belongs; number them in order"),
                ("S 2 1", "S 2 9", ":14: vertex 9 does not exist, there are 8 before this line; correct the "
                                   "surface"),
                ("S 2 1", "S 2 99999999999999999999", ":14: vertex number `99999999999999999999` is not a "
                                                      "whole number of 0 or more; correct it"),
                ("F  3", "F  2", ":3: F 2 is not read; F 3 and F 3a describe surfaces in space"),
                ("F  3", "!", ":13: no F line before the first surface; write F 3 above it"),
                ("0.9 west", "1.5 west", ":14: emissivity 1.5 is outside 0 to 1; correct it"),
                ("0 0 0.9 west", "0 7 0.9 west", ":14: surface 7 does not exist, there are 6; correct it"),
                ("0 0 0.9 west", "0 3 0.9 west", ":14: surface 3, which it is combined with, does not come "
                                                 "before it; renumber"),
                ("0 0 0.9 west", "0 1 0.8 west", ":14: its emissivity 0.8 differs from 0.9 of surface 1, "
                                                 "which it is combined with; give both one, or do not "
                                                 "combine them"),
                ("0 0 0.9 west", "2 0 0.9 west", ":14: its base surface 2 does not come before it; renumber"),
                ("0 0 0.9 west", "1 0 0.9 west", ":14: it must lie in the plane of its base surface 1 and "
                                                 "face as it does; correct the order of its vertices"),
                ("S 2 1", "N 2 1", ":14: a mask or null surface covers a base surface; name it in the column "
                                   "base"),
                ("S 2 1", "Surface 2 1", ":14: `Surface` begins no View3D line (T C F V S M N O E); correct or "
                                         "remove it"),
                ("0 0 0.9 north\nEnd of data\nnot read any more\n", "0", ":18: the file ends where a combined "
                 "surface belongs; add it"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))
        self.says(": no surfaces (no S lines); write them as the View3D manual says", "T nothing\nF 3\n")
        more = flat((.5, .5), (1.5, .5), (1, 1))
        self.says(":22: it is not within its base surface 1; correct or divide it",
                  lines(CUBE_VERTICES + more, walls() + [("S", "9 10 11 0 1 0 .5 rug")]))
        raised = [(x, y, .1) for x, y in ((.2, .2), (.4, .2), (.3, .3))]
        self.says(":22: it does not lie in the plane of its base surface 1; correct it",
                  lines(CUBE_VERTICES + raised, walls() + [("S", "9 10 11 0 1 0 .5 rug")]))


if __name__ == "__main__":
    sys.exit(unittest.main())
