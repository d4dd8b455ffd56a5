"""Rooms that face outward, caps that face the other way, and the options --flip and --without."""

import csv
import math
import sys
import unittest

from cli_runner import CliTest

SIZE = (4.0, 3.0, 2.5)
WALLS = ("floor", "ceiling", "south", "north", "west", "east")


def sides(low, high):
    """The six rectangles of a box, counter-clockwise seen from outside, by name."""
    (a, b, c), (x, y, z) = low, high
    return {"floor": [(a, b, c), (a, y, c), (x, y, c), (x, b, c)],
            "ceiling": [(a, b, z), (x, b, z), (x, y, z), (a, y, z)],
            "south": [(a, b, c), (x, b, c), (x, b, z), (a, b, z)],
            "north": [(a, y, c), (a, y, z), (x, y, z), (x, y, c)],
            "west": [(a, b, c), (a, b, z), (a, y, z), (a, y, c)],
            "east": [(x, b, c), (x, y, c), (x, y, z), (x, b, z)]}


def stl(faces, place=lambda p: p):
    """Named solids, each of one rectangle or a list of them."""
    lines = []
    for name, rectangles in faces.items():
        lines.append(f"solid {name}")
        if isinstance(rectangles[0][0], float):
            rectangles = [rectangles]
        for r in rectangles:
            for corners in ((r[0], r[1], r[2]), (r[0], r[2], r[3])):
                lines += ["facet normal 0 0 0", "outer loop"]
                lines += ["vertex " + " ".join(repr(v) for v in place(p)) for p in corners]
                lines += ["endloop", "endfacet"]
        lines.append(f"endsolid {name}")
    return "\n".join(lines) + "\n"


def between_opposed(a, b, c):
    """Form factor between equal, directly opposed rectangles a x b at the distance c (Howell C-11)."""
    x, y = a / c, b / c
    return 2 / (math.pi * x * y) * (
        math.log(math.sqrt((1 + x * x) * (1 + y * y) / (1 + x * x + y * y)))
        + x * math.sqrt(1 + y * y) * math.atan(x / math.sqrt(1 + y * y))
        + y * math.sqrt(1 + x * x) * math.atan(y / math.sqrt(1 + x * x))
        - x * math.atan(x) - y * math.atan(y))


def skew(scale, move):
    """Turned by 0.7 about z, then 0.4 about x; scaled and moved."""
    def place(p):
        x, y, z = p
        x, y = x * math.cos(.7) - y * math.sin(.7), x * math.sin(.7) + y * math.cos(.7)
        y, z = y * math.cos(.4) - z * math.sin(.4), y * math.sin(.4) + z * math.cos(.4)
        return tuple(scale * (v + move) for v in (x, y, z))
    return place


BOX = {name: list(face) for name, face in sides((0.0, 0.0, 0.0), SIZE).items()}
TURNED = {name: face[::-1] for name, face in BOX.items()}
SHELL = "the closed shell floor, ceiling, south, north, west, east faces outward"
HEAT = ["--condition", "*.emissivity=1", "--condition", "*.flux=0", "--condition", "floor.temperature=300"]


class TurnedOver(CliTest):
    def factors(self, *options):
        return self.run_program("factors", "a.stl", "--patches", "60", "--between", "surfaces", "-o", "f.csv",
                                *options)

    def value(self, row, column):
        """An entry of the table that factors() wrote."""
        with (self.folder / "f.csv").open() as file:
            lines = [line for line in csv.reader(file) if line and not line[0].startswith("#")]
        at = lines[0].index(column)
        return next(float(line[at]) for line in lines[1:] if line[0] == row)

    def test_a_room_that_faces_outward_is_said_and_turned(self):
        expected = between_opposed(*SIZE)
        self.assertAlmostEqual(expected, .292074, 6)
        for place in [lambda p: p, skew(1e-3, 0), skew(1e3, 0), skew(1, 1e3)]:
            self.write("a.stl", stl(BOX, place))
            run = self.factors()
            self.assertIn("WARNING: no surface sees another", run.err)
            self.assertIn(SHELL, run.err)
            self.assertIn("--flip all", run.err)
            run = self.factors("--flip", "all")
            self.assertNotIn("outward", run.err)
            self.assertIn("12 faces", run.err + run.out)
            self.assertIn("turned over", run.err + run.out)
            # Single precision and the closed forms' 1e-5; table in four to six digits.
            self.assertAlmostEqual(self.value("floor", "ceiling"), expected, delta=2e-5)

    def test_every_method_says_it(self):
        self.write("a.stl", stl(BOX))
        for method in ("exact", "rays", "hemicube"):
            with self.subTest(method=method):
                self.assertIn(SHELL, self.factors("--method", method).err)
        # Here corners of different faces are not joined, so that nothing is proved closed.
        self.assertIn("WARNING: no surface sees another",
                      self.run_program("factors", "a.stl", "--faces-as-patches").err)
        lit = self.run_program("gather", "a.stl", "--patches", "60", "--set", "floor.radiance=1",
                               "--resolution", "32")
        self.assertIn(SHELL, lit.err)

    def test_such_a_result_is_not_called_usable(self):
        self.write("a.stl", stl(BOX))
        condition = "only if no surface is meant to see another"
        heat = self.report("heat", "a.stl", "--patches", "60", *HEAT)["heat"]
        self.assertEqual(heat["usable"], condition)
        self.assertTrue(heat["message"].endswith("usable; " + condition), heat["message"])
        lit = self.report("solve", "a.stl", "--patches", "60", "--set", "ceiling.radiance=1")["solution"]
        self.assertEqual(lit["usable"], condition)
        heat = self.report("heat", "a.stl", "--patches", "60", *HEAT, "--flip", "all")["heat"]
        self.assertIs(heat["usable"], True)

    def test_info_says_what_a_lone_shell_is(self):
        self.write("a.stl", stl(BOX))
        text = "faces outwards and is all there is: nothing inside sees anything; if it is a room, " \
               "turn it over, --flip all"
        self.assertIn("warning: floor, ceiling, south, north and 2 more: closed, " + text,
                      self.run_program("info", "a.stl").err)
        lit = self.run_program("info", "a.stl", "--sky", "1")
        self.assertIn("note: floor, ceiling, south, north and 2 more: closed, " + text, lit.out)
        self.assertNotIn(text, lit.err)
        self.assertNotIn(text, self.run_program("info", "a.stl", "--flip", "all").err)

    def test_furniture_is_right_where_the_room_is_wrong(self):
        table = list(sides((1.0, 1.0, 0.5), (2.0, 2.0, 1.0)).values())
        self.write("a.stl", stl({**BOX, "table": table}))
        run = self.factors()
        turn = " ".join(f"--flip '{name}'" for name in WALLS)
        self.assertIn("WARNING: table: lies wholly inside the closed solid floor, ceiling, south, north "
                      f"and 2 more and was dropped; if that is a room, its faces are turned outward: "
                      f"turn it over, {turn}", run.err)
        self.assertIn(SHELL, run.err)
        self.assertNotIn("WARNING", self.factors(*turn.replace("'", "").split()).err)
        pairs = (("floor", "ceiling"), ("table", "floor"), ("west", "table"))
        mended = {pair: self.value(*pair) for pair in pairs}
        # As by a file that has the room right.
        self.write("a.stl", stl({**TURNED, "table": table}))
        self.factors()
        for row, column in pairs:
            # Of the same mesh, but for the order in which patches are numbered.
            self.assertAlmostEqual(mended[row, column], self.value(row, column), delta=1e-4)

    def test_shells_that_are_right_are_not_said_to_be_wrong(self):
        # A hollow solid; two blocks side by side; a block over a street.
        outer = list(sides((-1.0, -1.0, -1.0), (5.0, 4.0, 3.5)).values())
        other = list(sides((6.0, 0.0, 0.0), (7.0, 3.0, 2.0)).values())
        street = [(-9.0, -9.0, -1.0), (9.0, -9.0, -1.0), (9.0, 9.0, -1.0), (-9.0, 9.0, -1.0)]
        for scene in ({**TURNED, "outer": outer}, {**BOX, "other": other}, {**BOX, "street": street}):
            self.write("a.stl", stl(scene))
            run = self.factors()
            self.assertNotIn("--flip", run.err)
            self.assertNotIn("WARNING", run.err)

    def test_a_body_in_the_sky_may_be_all_there_is(self):
        self.write("a.stl", stl(BOX))
        # Black, with .5 of the sky's pi W/m^2 reflected: the right light, and no failure.
        lit = self.report("solve", "a.stl", "--patches", "60", "--sky", "1")["solution"]
        self.assertEqual(lit["status"], "converged")
        self.assertEqual(lit["usable"], "only if no surface is meant to see another")

    def test_plates_that_turn_their_backs_are_said(self):
        self.write("a.stl", stl({"low": BOX["floor"], "high": BOX["ceiling"]}))
        self.assertIn("WARNING: no surface sees another, all form factors are 0: if surfaces are to face "
                      "each other, turn some over, --flip NAME", self.factors().err)
        # One plane is as it must be.
        self.write("a.stl", stl({"low": BOX["floor"]}))
        self.assertNotIn("--flip", self.factors().err)

    def test_a_cap_that_faces_the_other_way_is_said_and_turned(self):
        # A duct: the shell outward, one end in two solids inward, where only its rim meets the shell.
        (a, b, c), (x, y, z) = (0.0, 0.0, 0.0), SIZE
        inner = [(1.0, 1.0, c), (3.0, 1.0, c), (3.0, 2.0, c), (1.0, 2.0, c)]
        outer = [(a, b, c), (x, b, c), (x, y, c), (a, y, c)]
        rim = [[outer[k], outer[(k + 1) % 4], inner[(k + 1) % 4], inner[k]] for k in range(4)]
        walls = {name: face for name, face in BOX.items() if name != "floor"}
        for place in [lambda p: p, skew(1e-3, 0)]:
            self.write("a.stl", stl({**walls, "rim": rim, "inlet": inner}, place))
            run = self.factors()
            for name in ("rim", "inlet"):
                self.assertIn(f"WARNING: {name}: its faces are turned against their neighbours and look into "
                              f"a closed, dark space, so it was dropped; turn it over, --flip '{name}'",
                              run.err)
            self.assertNotIn("closed solid", run.err)
            run = self.factors("--flip", "rim", "--flip", "inlet")
            self.assertNotIn("turned against", run.err)

    def test_surfaces_are_left_out(self):
        table = list(sides((1.0, 1.0, 0.5), (2.0, 2.0, 1.0)).values())
        self.write("a.stl", stl({**TURNED, "table": table}))
        run = self.factors("--without", "tab*")
        self.assertIn("tab* (table): 12 faces, 4 m^2, left out", run.err + run.out)
        self.assertAlmostEqual(self.value("floor", "ceiling"), between_opposed(*SIZE), delta=2e-5)
        self.assertNotIn("table", run.out.split("floor", 1)[1])
        self.refuse("info", "a.stl", "--without", "tabel",
                    words=["--without tabel: no surface, material or object is called tabel; there are: table, "])
        self.refuse("info", "a.stl", "--without", "*", words=["--without *: leaves no face; keep a surface"])

    def test_results_files_are_turned_too(self):
        self.write("a.stl", stl(BOX))
        self.run_program("factors", "a.stl", "--patches", "60", "-o", "a.h5")
        self.run_program("factors", "a.h5", "--between", "surfaces", "-o", "f.csv", "--flip", "all")
        self.assertAlmostEqual(self.value("floor", "ceiling"), between_opposed(*SIZE), delta=2e-5)


if __name__ == "__main__":
    sys.exit(unittest.main())
