"""Pictures in light's own units, and layers of pictures: channels of an .exr against closed forms."""

import csv
import math
import re
import unittest

import h5py
import numpy as np

from cli_runner import CliTest
from exr_file import ExrFile

LUMENS = 683  # a watt
WIDTH, HEIGHT = 40, 30
HIGH = 3  # metres, of the camera over the floor
FOV = 60
VIEW = ["--camera", f"eye=2,{HIGH},2;target=2,0,2;up=0,0,-1;fov={FOV}", "--width", str(WIDTH), "--height",
        str(HEIGHT), "--samples", "1"]
# White and black floors of 4 x 4 m, side by side, seen from above, with nothing around.
FLOOR = """mtllib floor.mtl
v 0 0 0
v 0 0 4
v 2 0 4
v 2 0 0
v 4 0 4
v 4 0 0
o left
usemtl pale
f 1 2 3 4
o right
usemtl dark
f 4 3 5 6
"""
MATERIALS = "newmtl pale\nKd .6 .6 .6\nnewmtl dark\nKd .1 .2 .3\n"
CANDELA = 500
LAMP = ["--light", f"point,{CANDELA}cd,at=1,2,1.5"]


def floor_places():
    """x and z on the floor of each pixel's middle: picture right is +x, picture down is +z."""
    focal = HEIGHT / 2 / math.tan(math.radians(FOV) / 2)
    column, row = np.meshgrid(np.arange(WIDTH) + .5, np.arange(HEIGHT) + .5)
    return 2 + HIGH * (column - WIDTH / 2) / focal, 2 + HIGH * (row - HEIGHT / 2) / focal


def point_lux(x, z):
    """I cos(t) / d^2 of a point of `CANDELA`."""
    across = np.hypot(x - 1, z - 1.5)
    return CANDELA * 2 / (4 + across**2) ** 1.5


class ShownLight(CliTest):
    def setUp(self):
        super().setUp()
        self.write("floor.obj", FLOOR)
        self.write("floor.mtl", MATERIALS)

    def draw(self, *arguments):
        report = self.report("render", "floor.obj", *LAMP, *VIEW, *arguments, "-o", "p.exr")
        return report.get("shown"), ExrFile(self.folder / "p.exr")

    def test_illuminance_and_luminance_of_a_point_lamp(self):
        x, z = floor_places()
        on_floor = (np.abs(x - 2) < 2) & (np.abs(z - 2) < 2)
        reflectance = np.where(x < 2, .6, .2126 * .1 + .7152 * .2 + .0722 * .3)
        for quantity, unit, truth in (
                ("illuminance", "lx", point_lux(x, z)),
                ("luminance", "cd/m^2", reflectance * point_lux(x, z) / math.pi),
                ("radiance", "W/m^2/sr", reflectance * point_lux(x, z) / math.pi / LUMENS)):
            for how in (["--final-gather"], ["--element-tolerance", ".0005"]):
                report, file = self.draw("--show", quantity, *how)
                self.assertEqual(file.texts["unit"], unit)
                self.assertEqual(file.texts[quantity + ".unit"], unit)
                self.assertIn(quantity, file.texts["quantity"])
                found = file.channels[quantity]
                np.testing.assert_array_equal(file.channels["A"], on_floor)
                np.testing.assert_array_equal(found[~on_floor], 0)
                # At a pixel, light is exact but for the 2e-6 that points stand off; between vertices of
                # elements it is linear, off by the tolerance of direct light.
                off = 1e-5 if "--final-gather" in how else .002
                np.testing.assert_allclose(found[on_floor], truth[on_floor], rtol=off)
                self.assertAlmostEqual(report["highest"] / found.max(), 1, delta=1e-6)
                self.assertEqual("lumens" in report, quantity != "radiance")

    def test_ends_of_the_colours_can_be_given(self):
        for option in (["--range", "0,50"], []):
            self.draw("--show", "illuminance", *option, "-o", "p.png")
        for wrong, said in ((["--range", "5,5", "--show", "luminance", "-o", "p.png"], "--range: '5,5'"),
                            (["--range", "0,5", "-o", "p.png"], "--range: is of false colours"),
                            (["--range", "0,5", "--show", "luminance"], "--range: is of false colours"),
                            (["--show", "luminence"], "luminance")):
            run = self.run_program("render", "floor.obj", *LAMP, *VIEW, *wrong, "-o", "p.exr", code=2)
            self.assertIn(said, run.err)

    def test_layers_of_a_floor(self):
        x, z = floor_places()
        on_floor = (np.abs(x - 2) < 2) & (np.abs(z - 2) < 2)
        for how in ([], ["--final-gather"]):
            report, file = self.draw("--layers", *how)
            layer = file.channels
            self.assertEqual(set(layer), {
                *"RGBA", "depth.Z", *("normal." + a for a in "XYZ"), "patch", "surface",
                *(f"{name}.{c}" for name in ("albedo", "direct", "indirect") for c in "RGB"),
                *(["error"] if how else [])})
            self.assertEqual({name: text for name, text in file.texts.items() if name.endswith(".unit")},
                             {"depth.unit": "m", "direct.unit": "W/m^2/sr", "indirect.unit": "W/m^2/sr"})
            # Along the view direction a plane that faces the camera is everywhere as far.
            np.testing.assert_allclose(layer["depth.Z"][on_floor], HIGH, rtol=1e-6)
            self.assertTrue(np.all(np.isinf(layer["depth.Z"][~on_floor])))
            for axis, value in zip("XYZ", (0, 1, 0)):
                np.testing.assert_array_equal(layer["normal." + axis], np.where(on_floor, value, 0))
            np.testing.assert_array_equal(layer["surface"], np.where(on_floor, np.where(x < 2, 0, 1), -1))
            self.assertTrue(np.all((layer["patch"] >= 0) == on_floor))
            for colour, dark in zip("RGB", (.1, .2, .3)):
                truth = np.where(on_floor, np.where(x < 2, .6, dark), 0)
                np.testing.assert_allclose(layer["albedo." + colour], truth, rtol=1e-6)
                # A flat floor sees none of its own light.
                np.testing.assert_array_equal(layer["indirect." + colour], 0)
                np.testing.assert_array_equal(layer["direct." + colour], layer[colour])
            if how:
                np.testing.assert_array_equal(layer["error"], 0)  # there is nothing to find by rays

    def test_at_its_edge_a_floor_is_the_sum_of_its_layers_too(self):
        self.run_program("render", "floor.obj", *LAMP, *VIEW[:-1], "4", "--layers", "-o", "p.exr")
        layer = ExrFile(self.folder / "p.exr").channels
        edge = (layer["A"] > 0) & (layer["A"] < 1)
        self.assertGreater(np.count_nonzero(edge), 50)
        for colour in "RGB":
            # Each is rounded to single precision.
            np.testing.assert_allclose(layer["direct." + colour] + layer["indirect." + colour], layer[colour],
                                       rtol=1e-6, atol=1e-9)

    def test_layers_need_elements_and_an_exr(self):
        for wrong, said in ((["-o", "p.png"], "--layers: are channels of an .exr"),
                            (["-o", "p.exr", "--elements", "off"], "leave out --elements off"),
                            (["-o", "p.exr", "--flat"], "leave out --flat"),
                            (["-o", "p.exr", "--show", "luminance"], "leave out --show")):
            run = self.run_program("render", "floor.obj", *LAMP, *VIEW, "--layers", *wrong, code=2)
            self.assertIn(said, run.err)

    def test_light_of_a_closed_box_is_the_sum_of_its_layers(self):
        self.report("render", "box.obj", "--patches", "100", "--layers", "--width", "32", "--samples", "2",
                    "--final-gather", "-o", "p.exr")
        layer = ExrFile(self.folder / "p.exr").channels
        self.assertGreater(layer["indirect.G"].max(), 0)
        for colour in "RGB":
            # Each is rounded to single precision.
            np.testing.assert_allclose(layer["direct." + colour] + layer["indirect." + colour], layer[colour],
                                       rtol=1e-6)
        self.assertGreater(layer["error"].max(), 0)
        self.assertLess(layer["error"].max(), .1)


class Tables(CliTest):
    """Files of a solution: light in lux beside watts, if the lamps were given so."""

    def setUp(self):
        super().setUp()
        self.write("floor.obj", FLOOR)
        self.write("floor.mtl", MATERIALS)

    def solve(self, lamp):
        self.run_program("solve", "floor.obj", "--light", lamp, "--patches", "20", "-o", "s.csv", "-o", "s.h5",
                         "-o", "s.vtp")
        with open(self.folder / "s.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        return rows, (self.folder / "s.vtp").read_text()

    def test_photometric_lamps(self):
        rows, vtp = self.solve("point,500cd,at=1,2,1.5")
        lux = np.array([float(row["illuminance_lx"]) for row in rows])
        watts = np.array([[float(row[f"irradiance_{b}_W_per_m2"]) for b in (1, 2, 3)] for row in rows])
        np.testing.assert_allclose(lux, LUMENS * watts @ (.2126, .7152, .0722), rtol=1e-12)
        # Means over patches of light from a point are exact.
        area = np.array([float(row["area_m2"]) for row in rows])
        self.assertAlmostEqual(area @ lux / flux_on_floor(), 1, delta=1e-6)
        pale = np.array([row["name"] == "left" for row in rows])
        luminance = np.array([float(row["luminance_cd_per_m2"]) for row in rows])
        np.testing.assert_allclose(luminance[pale], .6 * lux[pale] / math.pi, rtol=1e-12)
        with h5py.File(self.folder / "s.h5") as file:
            for name, unit, truth in (("illuminance", "lx", lux), ("luminance", "cd/m^2", luminance)):
                self.assertEqual(file["solution"][name].attrs["unit"], unit.encode())
                np.testing.assert_array_equal(file["solution"][name][()], truth)
                self.assertRegex(vtp, f'Name="{name}"[^>]*>[^<]*<InformationKey name="UNITS_LABEL"[^>]*>'
                                      + re.escape(unit))
        # The results file remembers it, and so does a lamp that is moved.
        run = self.run_program("solve", "s.h5", "--set", "point.at=1,2,2", "-o", "moved.csv")
        self.assertIn("illuminance_lx", (self.folder / "moved.csv").read_text().splitlines()[0], run.out)

    def test_radiometric_lamps(self):
        rows, vtp = self.solve("point,5W/sr,at=1,2,1.5")
        self.assertEqual(list(rows[0]), ["row", "name", "area_m2", *(
            f"{name}_{b}_W_per_m2" for name in ("radiosity", "irradiance", "net_flux") for b in (1, 2, 3))])
        self.assertNotIn("illuminance", vtp)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertNotIn("illuminance", file["solution"])


def flux_on_floor():
    """I times the solid angle of the floor, from corners: atan(a b / (h sqrt(a^2 + b^2 + h^2))), h = 2."""
    def corner(a, b):
        return math.atan(a * b / (2 * math.sqrt(a * a + b * b + 4)))
    return CANDELA * sum(corner(a, b) for a in (1, 3) for b in (1.5, 2.5))


if __name__ == "__main__":
    unittest.main()
