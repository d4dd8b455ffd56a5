"""Illuminance at points and on grids: published cases, hand formulas, files, refusals."""

import csv
import math
import struct
import unittest

import numpy as np

from cli_runner import DATA, CliTest

LUMENS = 683  # a watt


def room(width, depth, height, panel=0.0):
    """An .obj of a closed room, y up, middle of the floor at the origin; a panel in its ceiling."""
    w, d, a = width / 2, depth / 2, panel / 2
    corners = [(x, y, z) for y in (0, height) for x, z in ((-w, -d), (w, -d), (w, d), (-w, d))]
    corners += [(x, height, z) for x, z in ((-a, -a), (a, -a), (a, a), (-a, a))]
    faces = {"floor": "1 4 3 2", "ceiling": "5 6 7 8", "left": "1 5 8 4", "right": "2 3 7 6",
             "back": "1 2 6 5", "front": "4 8 7 3"}
    text = "mtllib room.mtl\n" + "".join("v %.17g %.17g %.17g\n" % p for p in corners)
    text += "".join(f"o {name}\nusemtl wall\nf {face}\n" for name, face in faces.items())
    return text + ("o panel\nusemtl lamp\nf 9 10 11 12\n" if panel else "")


def materials(reflectance, radiance=0.0):
    return (f"newmtl wall\nKd {reflectance} {reflectance} {reflectance}\n"
            f"newmtl lamp\nKd 0 0 0\nKe {radiance} {radiance} {radiance}\n")


class Illuminance(CliTest):
    def measure(self, *arguments):
        """The rows of the table, by name of the column."""
        self.run_program("illuminance", *arguments, "-o", "out.csv")
        with open(self.folder / "out.csv", newline="") as file:
            return list(csv.DictReader(file))

    def lux_at(self, points, *arguments):
        self.write("points.csv", "x,y,z,nx,ny,nz\n" + "".join(",".join(map(str, p)) + "\n" for p in points))
        rows = self.measure(*arguments, "--points", "points.csv")
        return np.array([float(row["illuminance_lx"]) for row in rows])

    def write_room(self, *size, reflectance, radiance=0.0):
        self.write("room.obj", room(*size))
        self.write("room.mtl", materials(reflectance, radiance))
        return "room.obj"

    def test_cie_171_5_2_a_cosine_point(self):
        """1000 cd straight down, cosine, 3 m over the floor: E = I h^2 / d^4. A panel of 1 cm is that point
        to (size / distance)^2 = 1e-5."""
        scene = self.write_room(4, 4, 3, 0.01, reflectance=0, radiance=1000 / 1e-4 / LUMENS)
        places = [(0, 0), (.5, 0), (1, 0), (1.5, 0), (.5, .5), (1, .5), (1.5, .5), (1, 1), (1.5, 1), (1.5, 1.5)]
        table = [111.11, 105.19, 90.00, 71.11, 99.72, 85.66, 68.05, 74.38, 59.98, 49.38]
        found = self.lux_at([(x, 0, z, 0, 1, 0) for x, z in places], scene)
        closed = [1000 * 9 / (9 + x * x + z * z) ** 2 for x, z in places]
        np.testing.assert_allclose(found, closed, rtol=3e-5)
        # The table differs in its last digits, by up to .2%.
        np.testing.assert_allclose(found, table, rtol=3e-3)

    def test_cie_171_5_3_a_panel_in_the_ceiling(self):
        scene = self.write_room(4, 4, 3, 1, reflectance=0, radiance=1000 / LUMENS)
        wall = [(2, y, 0, -1, 0, 0) for y in (2.75, 2.25, 1.75, 1.25, .75, .25)]
        floor = [(x, 0, 0, 0, 1, 0) for x in (.25, .75, 1.25, 1.75)]
        # Closed forms, to the digits that they were given with; points stand 1.3e-5 m off.
        np.testing.assert_allclose(self.lux_at(wall + floor, scene),
                                   [32.68, 75.19, 81.32, 69.06, 53.40, 40.00, 105.78, 95.67, 79.26, 61.42],
                                   atol=0.007)

    def test_cie_171_5_6_a_floor_that_shines(self):
        """100 lm/m^2 from a floor of 4 x 4 m: configuration factors in percent."""
        radiance = str(100 / LUMENS / math.pi)
        self.write("room.mtl", materials(0) + f"newmtl shines\nKd 0 0 0\nKe {' '.join(3 * [radiance])}\n")
        self.write("room.obj", room(4, 4, 3).replace("o floor\nusemtl wall", "o floor\nusemtl shines"))
        wall = [(2, y, 0, -1, 0, 0) for y in (.75, 1.25, 1.75, 2.25, 2.75)]
        ceiling = [(x - 2, 3, 0, 0, -1, 0) for x in (.25, .75, 1.25, 1.75)]
        # To the digits given; points stand 1.3e-5 m off.
        found = self.lux_at(wall + ceiling, "room.obj")
        np.testing.assert_allclose(found[:5], [35.901, 27.992, 21.639, 16.716, 12.967], atol=1e-3)
        np.testing.assert_allclose(found[5:], [26.80, 30.94, 33.98, 35.57], atol=6e-3)

    def test_cie_171_5_8_light_between_walls(self):
        """A cube of 4 m, 10,000 lm in its middle: indirect light of mean Phi rho / (S (1 - rho))."""
        scene = self.write_room(4, 4, 4, reflectance=.5)
        for rho in (.1, .5, .8):
            self.write("room.mtl", materials(rho))
            report = self.report("illuminance", scene, "--light", "point,10000lm,at=0,2,0",
                                 *[word for wall in ("floor", "ceiling", "left", "back")
                                   for word in ("--grid", f"{wall}:0:.125")])
            for k in range(4):
                found = report["illuminance" + (f"_{k + 1}" if k else "")]
                # The grid's mean of direct light, which is known, is off by .02%; rays are by less than
                # 1% each, 1,024 points.
                self.assertAlmostEqual(found["direct_mean_lx"], 10000 / 96, delta=.05)
                self.assertAlmostEqual(found["indirect_mean_lx"] / (10000 * rho / (96 * (1 - rho))), 1, delta=.002)

    def test_a_point_over_an_empty_floor(self):
        self.write("floor.obj", "v 0 0 0\nv 0 0 4\nv 6 0 4\nv 6 0 0\no floor\nf 1 2 3 4\n")
        lamp = np.array([1, 2, 1])
        rows = self.measure("floor.obj", "--light", "point,500cd,at=1,2,1", "--grid", "floor:.8:.5", "--set",
                            "default.reflectance=0")
        self.assertEqual(len(rows), 12 * 8)
        expected = []
        for row in rows:
            to = lamp - [float(row[axis]) for axis in ("x_m", "y_m", "z_m")]
            distance = np.linalg.norm(to)
            expected.append(500 * 1.2 / distance**3)
            sine = math.hypot(to[0], to[2]) / distance
            # 31 upright surfaces for the cylinder.
            self.assertAlmostEqual(float(row["cylindrical_lx"]), 500 * sine / (math.pi * distance**2), delta=.05)
        found = np.array([float(row["illuminance_lx"]) for row in rows])
        # 2e-6 of 7.2 m off their place, at 1.2 m.
        np.testing.assert_allclose(found, expected, rtol=4e-5)
        report = self.report("illuminance", "floor.obj", "--light", "point,500cd,at=1,2,1", "--grid",
                             "floor:.8:.5", "--set", "default.reflectance=0")["illuminance"]
        for key, value in (("mean_lx", np.mean(expected)), ("lowest_lx", min(expected)),
                           ("highest_lx", max(expected)), ("u0", min(expected) / np.mean(expected)),
                           ("ud", min(expected) / max(expected))):
            self.assertAlmostEqual(report[key] / value, 1, delta=1e-4)
        self.assertEqual(report["lowest_at_m"], [5.75, .8, 3.75])
        self.assertEqual(report["points"], 96)

    def test_files_say_what_they_hold(self):
        scene = self.write_room(4, 4, 3, 1, reflectance=.5, radiance=3)
        rows = self.measure(scene, "--grid", "floor:.8:1", "--plane", "0,1,0:0,1,1:1,1,1:.5", "-o", "plan.png",
                            "-o", "room.h5")
        self.assertEqual([row["points"] for row in rows], ["floor + 0.8 m"] * 16 + ["plane"] * 4)
        for row in rows:
            watts = [float(row[f"irradiance_{b}_W_per_m2"]) for b in (1, 2, 3)]
            self.assertAlmostEqual(float(row["illuminance_lx"]), LUMENS * np.dot(watts, (.2126, .7152, .0722)),
                                   places=6)
            self.assertAlmostEqual(float(row["direct_lx"]) + float(row["indirect_lx"]),
                                   float(row["illuminance_lx"]), places=6)
            # Facing up: the upper face of a cube.
            self.assertAlmostEqual(float(row["facing_+y_lx"]) / float(row["illuminance_lx"]), 1, delta=.02)
            self.assertLessEqual(float(row["standard_error"]), .01)
        png = (self.folder / "plan.png").read_bytes()
        self.assertEqual(png[:8], b"\x89PNG\r\n\x1a\n")
        width, height = struct.unpack(">II", png[16:24])
        self.assertGreaterEqual(width, 720)
        self.assertGreater(height, width)  # two plans
        # A results file has all that is needed, and gives the same light.
        again = self.measure("room.h5", "--grid", "floor:.8:1")
        np.testing.assert_allclose([float(row["illuminance_lx"]) for row in again],
                                   [float(row["illuminance_lx"]) for row in rows[:16]], rtol=1e-9)

    def test_a_pattern_has_a_grid_for_each_wall(self):
        scene = self.write_room(4, 6, 3, 1, reflectance=.5, radiance=3)
        report = self.report("illuminance", scene, "--grid", "[lfr][eri]*:0:1", "-o", "walls.csv", "-o", "walls.png")
        found = [report[key] for key in ("illuminance", "illuminance_2", "illuminance_3")]
        self.assertEqual([of["facing"] for of in found], [[1, 0, 0], [-1, 0, 0], [0, 0, -1]])
        self.assertEqual([of["points"] for of in found], [18, 18, 12])
        with open(self.folder / "walls.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["points"] for row in rows],
                         ["left/wall"] * 18 + ["right/wall"] * 18 + ["front/wall"] * 12)

    def test_too_many_plans_are_refused(self):
        corners = [f"v {x} {.1 * k:g} {z}" for k in range(51) for x, z in ((k, 0), (k, 1), (k + .9, 1), (k + .9, 0))]
        steps = [f"o step_{k}\nusemtl wall\nf {' '.join(str(4 * k + n) for n in (1, 2, 3, 4))}" for k in range(51)]
        self.write("room.mtl", materials(.5))
        self.write("stairs.obj", "\n".join(["mtllib room.mtl", *corners, *steps]) + "\n")
        words = ["stairs.obj", "--light", "sun,1000lx,toward=0,1,0", "--grid", "step*:0:.9"]
        self.refuse("illuminance", *words, "-o", "plans.png", words=["plans.png: there are 51 grids", "50 plans"])
        self.assertEqual(len(self.measure(*words)), 51)

    def test_direct_light_by_rays_says_that_it_is_off(self):
        """A plate hides a part of a wide sun, which is 64 rays; nothing else sends light."""
        self.write("room.mtl", materials(0))
        self.write("plate.obj", "mtllib room.mtl\nusemtl wall\nv 0 0 0\nv 0 0 4\nv 6 0 4\nv 6 0 0\nv 2 2 1\nv 2 2 3\n"
                   "v 4 2 3\nv 4 2 1\no floor\nf 1 2 3 4\no plate\nf 5 6 7 8\n")
        words = ["plate.obj", "--light", "sun,1000lx,toward=.5,1,.3,diameter=10", "--two-sided", "plate", "--grid",
                 "floor:.5:.25"]
        found = self.run_program("illuminance", *words)
        self.assertIn("at some points direct or indirect light took all rays that it may, and the standard error is "
                      "above 1 %", found.out)
        # Its first rays of indirect light find nothing.
        self.assertEqual(self.report("illuminance", *words)["measuring"]["most_rays"], 1024)

    def test_a_point_in_a_body_is_left_out(self):
        scene = self.write_room(4, 4, 3, 1, reflectance=.5, radiance=3)
        box = [(x, y, z) for y in (0, .9) for x, z in ((0, 0), (1, 0), (1, 1), (0, 1))]
        text = "".join("v %g %g %g\n" % p for p in box) + "o box\nusemtl wall\n"
        for face in ("13 14 15 16", "17 20 19 18", "13 17 18 14", "14 18 19 15", "15 19 20 16", "16 20 17 13"):
            text += f"f {face}\n"
        self.write("room.obj", room(4, 4, 3, 1) + text)
        report = self.report("illuminance", scene, "--grid", "floor:.8:.5")["illuminance"]
        self.assertEqual([report["points"], report["in_bodies"]], [64, 4])
        self.assertGreater(report["lowest_lx"], 0)
        run = self.run_program("illuminance", scene, "--plane", ".2,.5,.8:.8,.5,.8:.8,.5,.2:.2", "-o", "body.csv",
                               code=2)
        self.assertIn("radiosity: plane: all of its 9 points stand in bodies", run.err)
        self.assertNotIn("body.csv", self.files())

    def test_what_cannot_be_measured_is_refused(self):
        scene = self.write_room(4, 4, 3, 1, reflectance=.5, radiance=3)
        self.write("bad.csv", "x,y,z\n0,1,0\n0,one,0\n")
        for words, told in [
                ([], ["illuminance: say where"]),
                (["--grid", "flor"], ["no surface, material or object is called flor", "there are: floor"]),
                (["--grid", "floor:9"], ["floor + 9 m: all of its", "beyond the room"]),
                (["--grid", "floor:.8:.001"], ["at most 1,000,000 are evaluated", "give a larger one"]),
                (["--grid", "floor:.8:0"], ["a spacing of 0 m is no distance"]),
                (["--plane", "0,0,0:1,0,0"], ["--plane: '0,0,0:1,0,0' has 2 parts"]),
                (["--plane", "0,0,0:1,0,0:2,0,0"], ["three corners are in one line"]),
                (["--points", "bad.csv"], ["bad.csv:3: `one` in column y is no finite number"]),
                (["--points", "none.csv"], ["none.csv: no such file"]),
                (["--grid", "floor", "-o", "lit.glb"], ["lit.glb: illuminance writes .png"]),
                (["--points", "bad.csv", "-o", "bad.csv"], ["bad.csv: is the table of --points"]),
                (["--grid", "floor", "--range", "0,500"], ["--range: is of the plan's colours"]),
                (["--grid", "floor", "--range", "0;500", "-o", "plan.png"], ["--range: '0;500' is not two"]),
                (["--grid", "floor", "--ray-tolerance", "0"], ["--ray-tolerance: 0 is out of range"])]:
            with self.subTest(words):
                self.refuse("illuminance", scene, *words, words=told)
        self.write("points.csv", "0,1,0\n")
        self.refuse("illuminance", scene, "--points", "points.csv", "-o", "plan.png",
                    words=["plan.png: a plan is of a grid"])
        self.refuse("illuminance", DATA / "furnace-cube.obj", "--set", "wall.radiance=0", "--grid", "cube_floor",
                    words=["nothing in the scene emits"])


if __name__ == "__main__":
    unittest.main()
