"""Skies that are not alike in all directions: on the command line, in every step, and refused."""

import csv
import math
import unittest

import h5py
import numpy as np

from cli_runner import HAS_PAGES, SMALL, CliTest

# A floor in the open, y up, and a camera that looks to the north, level.
FLOOR = ("# camera eye=0,1,9 target=0,1,0 fov=60\no floor\n"
         "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n")
FEW = ["--patches", "4"]


def hdr(width, height, at):
    """A picture in Radiance's format, at(x, y) from the top left: powers of two come out exactly."""
    data = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    for y in range(height):
        for x in range(width):
            rgb = at(x, y)
            _, exponent = math.frexp(max(rgb))
            data += bytes([int(math.ldexp(value, 8 - exponent)) for value in rgb] + [exponent + 128])
    return data


class Skies(CliTest):
    def setUp(self):
        super().setUp()
        self.write("floor.obj", FLOOR)

    def irradiance(self, *arguments):
        """The mean over the floor of 4 square metres."""
        return np.array(self.report("solve", "floor.obj", *FEW, *arguments)["solution"]["from_sky_W"]) / 4

    def test_open_ground_gets_the_strength(self):
        # Rays to .5% of each of four patches, three times that; the scene's sun lights the ground, too.
        np.testing.assert_allclose(self.irradiance("--cie-sky", "1,2,3"), [1, 2, 3], rtol=7.5e-3)
        np.testing.assert_allclose(self.irradiance("--cie-sky", "6830lx,type=12,elevation=40"), 10, rtol=7.5e-3)
        np.testing.assert_allclose(
            self.irradiance("--perez-sky", "120", "--sun", "600,elevation=30,diameter=0"), 420, rtol=7.5e-3)

    def test_a_results_file_keeps_it(self):
        self.run_program("solve", "floor.obj", *FEW, "--cie-sky", "10,type=12", "--sun", "100,elevation=30",
                         "-o", "a.h5")
        self.assertIn("solution       reused", self.run_program("solve", "a.h5").out)
        # The sky's sun is the scene's, wherever that stands.
        run = self.run_program("render", "a.h5", "--set", "sun.elevation=60", "--width", "8", "-o", "p.exr")
        self.assertIn("form factors   reused", run.out)
        self.assertNotIn("solution       reused", run.out)
        (sun, sky) = self.report("info", "a.h5")["scene"]["lights"]
        self.assertEqual([sky["name"], sky["strength"], sky["stands"]],
                         ["cie-sky", "10, 10, 10 W/m^2", "from above the horizon"])
        run = self.run_program("solve", "a.h5", "--set", "cie-sky.type=1", "--without", "sun", "-o", "b.h5")
        self.assertIn("left out: sun", run.out)
        run = self.run_program("solve", "a.h5", "--without", "cie-sky", "-o", "c.h5")
        self.assertIn("left out: cie-sky", run.out)

    def test_pictures_show_it(self):
        (self.folder / "even.hdr").write_bytes(hdr(8, 4, lambda x, y: (1, 1, 1)))
        size = ["--width", "32", "--height", "24"]
        self.run_program("render", "floor.obj", *FEW, "--sky", "2", *size, "-o", "sky.exr")
        alike = f"{2 * math.pi},type=5,ground=1"
        for sky in (["--image-sky", "even.hdr,2"], ["--cie-sky", alike]):
            for more in ([], ["--final-gather"]):
                self.run_program("render", "floor.obj", *FEW, *sky, *size, *more, "-o", "other.exr")
                # One radiance all over, to the quadrature of it; final gather by as many rays of each.
                self.run_program("compare", "sky.exr", "other.exr", "--tolerance", "1e-5")

    def test_an_image_may_be_the_sky(self):
        (self.folder / "even.hdr").write_bytes(hdr(8, 4, lambda x, y: (1, 1, 1)))
        # The mean radiance of 1 all over is exact, whatever the rays.
        np.testing.assert_allclose(self.irradiance("--image-sky", "even.hdr,2"), 2 * math.pi, rtol=1e-12)
        self.run_program("solve", "floor.obj", *FEW, "--image-sky", "even.hdr", "-o", "a.h5")
        self.assertIn("solution       reused", self.run_program("solve", "a.h5").out)
        (self.folder / "even.hdr").write_bytes(hdr(8, 4, lambda x, y: (2, 2, 2)))
        self.assertNotIn("solution       reused", self.run_program("solve", "a.h5").out)
        (self.folder / "even.hdr").unlink()
        self.refuse("solve", "a.h5", words=["even.hdr: the image of the sky is not there"])
        self.write("text.hdr", "no image")
        self.refuse("solve", "floor.obj", "--image-sky", "text.hdr", words=["text.hdr", "cannot be decoded"])

    def test_the_daylight_factor_is_of_open_ground(self):
        points = ["--plane", "-.5,.1,.5:.5,.1,.5:.5,.1,-.5:.5"]
        run = self.report("illuminance", "floor.obj", *FEW, "--cie-sky", "10000lx", *points, "-o", "p.csv")
        # Rays to 1% of each point.
        self.assertAlmostEqual(run["illuminance"]["daylight_factor_mean_percent"], 100, delta=1)
        with open(self.folder / "p.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            self.assertAlmostEqual(float(row["daylight_factor_percent"]),
                                   float(row["illuminance_lx"]) / 100, delta=1e-9)
        for lights in (["--cie-sky", "10000lx,type=12,elevation=30"],
                       ["--cie-sky", "10000lx", "--light", "point,1W,at=0,1,0"],
                       ["--cie-sky", "10000lx", "--set", "floor.radiance=1"]):
            run = self.report("illuminance", "floor.obj", *FEW, *lights, *points)
            self.assertNotIn("daylight_factor_mean_percent", run["illuminance"])

    def test_gathering_is_as_solving(self):
        self.write("yard.obj", FLOOR + "o wall\nv 1 1 1\nv 1 1 -1\nv -1 1 1\nv -1 1 -1\n"
                                       "f 2 3 6 5\nf 1 7 8 4\n")
        sky = ["--cie-sky", "10,type=12,elevation=40,azimuth=100"]
        for eye in ("cpu", "auto"):
            self.run_program("compare", "yard.obj", *sky, "--gather", *SMALL, "--at", "patches", "--eye", eye,
                             "--tolerance", "0.03")

    def test_it_is_a_source_of_light(self):
        self.run_program("solve", "floor.obj", *FEW, "--cie-sky", "10,ground=.5", "--sun", "100,elevation=30",
                         "--basis", "surfaces", "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as file:
            self.assertEqual(sorted(file["basis/names"].asstr()), ["cie-sky", "sun"])
            together = file["solution/irradiance"][:]
            basis = file["basis/irradiance"][:].reshape(len(together), 2, 3)
        np.testing.assert_allclose(basis.sum(axis=1), together, rtol=1e-6)

    @unittest.skipUnless(HAS_PAGES, "built without pages")
    def test_a_page_says_what_it_leaves_out(self):
        run = self.run_program("view", "floor.obj", *FEW, "--cie-sky", "10", "-o", "p.html")
        self.assertIn("cie-sky: a page has what it lights", run.out)

    def test_what_it_lacks_is_said_in_a_line(self):
        def refused(*arguments, words):
            self.refuse("solve", "floor.obj", *arguments, words=words)
        refused("--cie-sky", "10,type=12", words=["where the sun stands", "elevation=DEGREES"])
        refused("--cie-sky", "10,type=17", words=["--cie-sky: type: 17 is out of range; 1 to 16"])
        refused("--cie-sky", "10,type=12,elevation=-3", words=["3.0 degrees below the horizon"])
        refused("--cie-sky", "inf", words=["--cie-sky: 'inf' is not one finite number"])
        refused("--cie-sky", "10lm", words=["'10lm' is not one finite number"])
        refused("--perez-sky", "100,elevation=30", words=["direct=W/m^2"])
        refused("--perez-sky", "1,direct=500,elevation=30", words=["less than any sky", "efficacy=LM/W"])
        refused("--image-sky", "1", words=["has no image; give file="])
        # A closed room sees none.
        run = self.run_program("solve", "box.obj", *SMALL, "--set", "lamp.radiance=0", "--cie-sky", "10")
        self.assertIn("no patch sees the sky (the scene is closed)", run.err)


if __name__ == "__main__":
    unittest.main()
