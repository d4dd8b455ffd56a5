"""Light of single lamps: solved for once, kept in a results file, mixed without a solve."""

import unittest

import h5py
import numpy as np

from cli_runner import SMALL, CliTest

# A residual of 1e-11 of the largest emission is an error of at most 1/(1 - 0.7) as much in a room
# of reflectance 0.7; emission is at most 5 times the smallest light here: 2e-10 of it.
EXACT = ["--solve-tolerance", "1e-11"]
CLOSE = 1e-9
ROOM = "room.emission=1,2,3"
NAMES = ["room/wall", "ceiling/lamp"]


class LightBasis(CliTest):
    def solve_lamps(self, *more):
        return self.report("solve", "box.obj", *SMALL, *EXACT, "--set", ROOM, "--basis", "surfaces",
                           "-o", "s.h5", *more)

    def table(self, name):
        with open(self.folder / name, encoding="utf-8") as file:
            header = next(line for line in file if not line.startswith("#")).strip().split(",")
            rows = [line.strip().split(",") for line in file]
        columns = [k for k, title in enumerate(header) if title.startswith(("radiosity",
                                                                            "irradiance"))]
        self.assertEqual(len(columns), 6)
        return np.array([[float(row[k]) for k in columns] for row in rows])

    def test_a_mixture_is_the_solution_of_the_same_emissions(self):
        report = self.solve_lamps()
        self.assertEqual([row["name"] for row in report["basis"]["sources"]], NAMES)
        mixed = self.report("solve", "s.h5", "--mix", "room/wall=2,ceiling/lamp=0.5", "-o",
                            "mixed.csv")
        self.assertEqual(mixed["stages"]["basis"]["action"], "reused")
        self.assertNotIn("solution", mixed["stages"])
        self.run_program("solve", "box.obj", *SMALL, *EXACT, "--set", "room.emission=2,4,6",
                         "--set", "ceiling.radiance=2.5,2,1.5", "-o", "full.csv")
        full = self.table("full.csv")
        np.testing.assert_allclose(self.table("mixed.csv"), full, rtol=CLOSE)
        # Not by chance: without one of the lamps it is another light.
        self.run_program("solve", "s.h5", "--mix", "room/wall=2", "-o", "other.csv")
        self.assertGreater(np.abs(self.table("other.csv") / full - 1).max(), 0.01)

    def test_sets_of_a_table_become_sources(self):
        self.write("day.csv", "set,name,r,g,b\nmorning,room,1,0,0\nmorning,ceiling,0,1,2\n"
                              "noon,ceiling,5,5,5\n")
        report = self.report("solve", "box.obj", *SMALL, *EXACT, "--basis", "day.csv", "-o", "s.h5")
        # 5 m^2 of walls and 1 m^2 of ceiling.
        self.assertEqual([(row["name"], row["emitted_W"]) for row in report["basis"]["sources"]],
                         [("morning", 8), ("noon", 15)])
        self.run_program("solve", "s.h5", "--mix", "morning=1,noon=0.1", "-o", "mixed.csv")
        self.run_program("solve", "box.obj", *SMALL, *EXACT, "--set", "room.emission=1,0,0",
                         "--set", "ceiling.emission=0.5,1.5,2.5", "-o", "full.csv")
        np.testing.assert_allclose(self.table("mixed.csv"), self.table("full.csv"), rtol=CLOSE)

    def test_the_basis_is_reused_kept_or_recomputed(self):
        self.solve_lamps()
        self.assertEqual(self.solve_lamps()["stages"]["basis"]["action"], "reused")
        # Another lamp is another solution; the light of single lamps stays.
        self.report("solve", "s.h5", "--set", "ceiling.emission=7")
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual([name.decode() for name in file["basis/names"][()]], NAMES)
        again = self.report("solve", "s.h5", "--basis", "surfaces")
        self.assertEqual(again["stages"]["basis"]["detail"], "sources changed")
        darker = self.report("solve", "s.h5", "--set", "room.reflectance=0.1")
        self.assertEqual(darker["stages"]["basis"]["action"], "dropped")

    def test_pictures_of_a_mixture_equal_those_of_a_full_solution(self):
        self.solve_lamps()
        self.run_program("solve", "box.obj", *SMALL, *EXACT, "--set", "room.emission=0", "-o",
                         "one.h5")
        camera = ["--camera", "eye=0.1,0.5,0.5;target=1,0.5,0.5", "--width", "32"]
        for elements in (["--elements", "off"], []):
            self.run_program("render", "s.h5", "--mix", "ceiling/lamp=1", *camera, *elements, "-o",
                             "m.exr")
            self.run_program("render", "one.h5", *camera, *elements, "-o", "f.exr")
            self.run_program("compare", "m.exr", "f.exr", "--tolerance", "1e-5")  # single precision
        self.run_program("solve", "s.h5", "--mix", "ceiling/lamp=1", "-o", "m.glb", "-o", "m.vtp")

    def test_impossible_mixtures_are_refused(self):
        self.solve_lamps()
        mix = ["solve", "s.h5", "-o", "m.csv", "--mix"]
        self.refuse(*mix, "lamp=1",
                    words=["there is no light 'lamp'; there are room/wall, ceiling/lamp"])
        self.refuse(*mix, "room/wall", words=["--mix: 'room/wall' is not NAME=WEIGHT"])
        self.refuse(*mix, "room/wall=-1", words=["not a finite factor >= 0"])
        self.refuse(*mix, "room/wall=1,room/wall=2", words=["'room/wall' is given twice"])
        self.refuse(*mix, "room/wall=1", "--set", "room.emission=3",
                    words=["--set changes what is solved"])
        self.refuse("solve", "s.h5", "--mix", "room/wall=1", words=["a file of its own"])
        self.run_program("factors", "box.obj", *SMALL, "-o", "f.h5")
        self.refuse("render", "f.h5", "--mix", "room/wall=1", "-o", "m.png",
                    words=["f.h5 has no light of single lamps", "--basis surfaces"])

    def test_tables_that_are_wrong_are_named(self):
        solve = ["solve", "box.obj", *SMALL, "-o", "s.h5", "--basis", "t.csv"]
        for text, words in (("set,name\na,room\n", "t.csv:1: the columns are set,name; there must"),
                            ("set,name,r,g,emission\na,room,1,1,1\n", "t.csv:1: the columns are"),
                            ("set,name,emission\n", "t.csv:1: no line follows"),
                            ("set,name,emission\na,door,1\n", "t.csv:2: nothing is called 'door'"),
                            ("set,name,emission\na,room,-1\n", "t.csv:2: emission `-1` is not"),
                            ("set,name,emission\na,room,1\na,room,2\n",
                             "t.csv:3: surface 'room/wall' is in the set 'a' twice")):
            self.write("t.csv", text)
            self.refuse(*solve, words=[words])
        self.refuse("solve", "box.obj", *SMALL, "--set", "ceiling.emission=0", "--basis",
                    "surfaces", "-o", "s.h5", words=["no surface emits light"])

    def test_a_damaged_basis_is_named(self):
        self.solve_lamps()
        with h5py.File(self.folder / "s.h5", "r+") as file:
            rows = file["basis/radiosity"][()]
            del file["basis/radiosity"]
            file["basis/radiosity"] = rows[1:]
        self.refuse("render", "s.h5", "--mix", "room/wall=1", "-o", "m.png",
                    words=["s.h5: /basis/radiosity has"])


if __name__ == "__main__":
    unittest.main()
