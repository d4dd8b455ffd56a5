"""Radiance scenes and pictures: the Cornell box is that of its OBJ, and pictures are read by the format's rules."""

import json
import math
import re
import unittest

import h5py
import numpy as np

from cie_171 import opposite
from cli_runner import DATA, SMALL, CliTest
from exr_file import ExrFile

LAMP = "light"


def as_rad(obj, mtl):
    """An OBJ's faces as polygons, its materials as plastic and light."""
    text, places, colours = "# a box\n", [], {}
    for line in mtl.splitlines():
        word, *rest = line.split() or [""]
        if word == "newmtl":
            name = rest[0]
        elif word == "Kd":
            colours[name] = f"void plastic {name}\n0\n0\n5 {' '.join(rest)} 0 0\n"
        elif word == "Ke" and name == LAMP:
            colours[name] = f"void light {name}\n0\n0\n3 {' '.join(rest)}\n"
    text += "\n".join(colours.values())
    for number, line in enumerate(obj.splitlines()):
        word, *rest = line.split() or [""]
        if word == "v":
            places.append(" ".join(rest))
        elif word == "o":
            name = rest[0]
        elif word == "usemtl":
            material = rest[0]
        elif word == "f":
            corners = "\n  ".join(places[int(corner) - 1] for corner in rest)
            text += f"\n{material} polygon {name}.{number}\n0\n0\n{3 * len(rest)}\n  {corners}\n"
    return text


def read_hdr(path):
    """Header and radiance, by Radiance's colour.c: a mantissa stands for the middle of its step."""
    header, size, pixels = re.fullmatch(rb"(#\?RADIANCE\n.*?)\n\n(-Y \d+ \+X \d+)\n(.*)", path.read_bytes(),
                                        re.DOTALL).groups()
    _, height, _, width = size.split()
    stored = np.frombuffer(pixels, np.uint8).reshape(int(height), int(width), 4).astype(float)
    light = (stored[..., :3] + .5) * np.exp2(stored[..., 3:] - 136)
    light[stored[..., 3] == 0] = 0
    return header.decode().splitlines(), light


class Radiance(CliTest):
    def test_the_cornell_box_is_that_of_its_obj(self):
        obj = (DATA / "cornell-box.obj").read_text()
        # A light of Radiance reflects nothing.
        mtl = re.sub(r"(newmtl light\nKd).*", r"\1 0 0 0", (DATA / "cornell-box.mtl").read_text())
        self.write("cornell-box.mtl", mtl)
        self.write("a.obj", obj)
        self.write("a.rad", as_rad(obj, mtl))
        few = ["--patches", "300", "--up", "y"]
        sides = [word for name in ("white", "red", "green") for word in ("--two-sided", name)]
        self.run_program("solve", "a.obj", *few, *sides, "-o", "obj.h5")
        self.run_program("solve", "a.rad", *few, "-o", "rad.h5")
        self.assert_same_factors("obj.h5", "rad.h5")
        with h5py.File(self.folder / "obj.h5") as a, h5py.File(self.folder / "rad.h5") as b:
            light = a["solution/radiosity"][()]
            self.assertGreater(light.max(), 0)
            np.testing.assert_array_equal(b["solution/radiosity"][()], light)
        surfaces = self.report("info", "a.rad")["scene"]["surfaces"]
        self.assertEqual([s["name"] for s in surfaces][:3], ["floor/white", "lamp/light", "ceiling/white"])

    def test_a_sphere_sends_all_of_its_power(self):
        # 4 pi r^2 times pi L.
        self.write("a.rad", "void light l 0 0 3 7 7 7\nl sphere s 0 0 4 1 2 3 .5\n")
        power = self.report("info", "a.rad")["scene"]["emitted_power_W"]
        np.testing.assert_allclose(power, 4 * math.pi * .25 * math.pi * 7, rtol=1e-9)
        coarse = self.report("info", "a.rad", "--curve-deviation", ".1")["scene"]
        np.testing.assert_allclose(coarse["emitted_power_W"], power, rtol=1e-9)
        self.refuse("info", "a.rad", "--curve-deviation", "0", words=["--curve-deviation", "1e-05"])

    def test_holes_are_seams(self):
        """A small plate a metre under a square of 10 m sees what is above through a hole of 2 m."""
        self.write("a.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n"
                   "grey polygon plate 0 0 12  -.005 -.005 0  .005 -.005 0  .005 .005 0  -.005 .005 0\n"
                   "grey polygon square 0 0 30  -5 -5 1  5 -5 1  5 5 1  -5 5 1  -5 -5 1\n"
                   "  -1 -1 1  -1 1 1  1 1 1  1 -1 1  -1 -1 1\n")
        self.run_program("factors", "a.rad", "--faces-as-patches", "--one-sided", "plate", "--tolerance", "1e-6",
                         "--between", "surfaces", "-o", "f.json")
        found = json.loads((self.folder / "f.json").read_text())
        factor = found["form_factors"][found["names"].index("plate/grey")][found["names"].index("square/grey")]
        # From a point; the plate is 1e-2 of the distance wide, which counts squared.
        expected = opposite(-5, 5, -5, 5, 1) - opposite(-1, 1, -1, 1, 1)
        self.assertAlmostEqual(factor, expected, delta=1e-4)

    def test_a_can_is_closed(self):
        self.write("a.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light bulb 0 0 3 1 1 1\n"
                   "grey tube can 0 0 7  1 1 1  2 3 4  .7\n"
                   "grey ring can.1 0 0 8  1 1 1  1 2 3  0 .7\n"
                   "grey ring can.2 0 0 8  2 3 4  -1 -2 -3  0 .7\n"
                   "bulb sphere lamp 0 0 4  1.5 2 2.5  .1\n")
        report = self.report("solve", "a.rad", "--one-sided", "can", "--patches", 200, "--curve-deviation", ".05",
                             "-o", "a.h5")
        power = 4 * math.pi * .01 * math.pi
        np.testing.assert_allclose(report["solution"]["emitted_W"], power, rtol=1e-6)
        np.testing.assert_allclose(report["solution"]["absorbed_W"], power, rtol=1e-4)  # the tolerance of the matrix
        np.testing.assert_allclose(report["solution"]["to_sky_W"], 0, atol=1e-5 * power)

    def test_pictures_are_radiance(self):
        camera = "eye=.5,.5,.9;target=.5,.5,0;fov=90"
        self.run_program("render", "box.obj", *SMALL, "--camera", camera, "--width", 24, "--height", 16,
                         "-o", "a.hdr", "-o", "a.exr")
        header, light = read_hdr(self.folder / "a.hdr")
        exr = ExrFile(self.folder / "a.exr")
        expected = np.stack([exr.channels[c] for c in "RGB"], axis=-1)
        # Half a step of a mantissa of 8 bits: 1/256 of the largest of three.
        error = np.abs(light - expected).max(axis=-1) / expected.max(axis=-1)
        self.assertLess(error.max(), 1 / 256)
        self.assertLess(abs(np.mean(light - expected)) / np.mean(expected), 5e-4)  # and no bias
        self.assertIn("unit= W/m^2/sr", header)
        self.assertIn("FORMAT=32-bit_rle_rgbe", header)
        view = next(line for line in header if line.startswith("VIEW= "))
        self.assertRegex(view, r"-vtv -vp 0.5 0.5 0.9 -vd 0 0 -1 -vu 0 1 0 -vh 112\.6\d* -vv 90")
        # And read by the program itself, which knows no half steps.
        self.assertLess(self.report("compare", "a.hdr", "a.exr")["comparison"]["relative_l2"], 1 / 128)

    def test_what_a_picture_cannot_hold(self):
        self.refuse("render", "box.obj", *SMALL, "--show", "luminance", "-o", "a.hdr",
                    words=["a.hdr", "radiance", ".exr"])
        self.refuse("render", "box.obj", *SMALL, "--layers", "-o", "a.hdr", words=["--layers", ".exr"])
        self.refuse("info", self.write("a.rad", "!genbox a b 1 1 1\n"), words=["a.rad:1:", "genbox", "xform"])


if __name__ == "__main__":
    unittest.main()
