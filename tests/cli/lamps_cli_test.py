"""Lights without a surface on the command line: given, kept in files, changed, left out, refused."""

import unittest

import h5py
import numpy as np

from cli_runner import DATA, SMALL, CliTest

LUMENS = 683  # a watt
DARK = ["--set", "lamp.radiance=0"]


class Lamps(CliTest):
    def power(self, *arguments):
        return self.report("solve", *arguments)["solution"]["from_sky_W"]

    def lights_of(self, scene):
        return self.report("info", scene)["scene"]["lights"]

    def test_a_closed_box_gets_all_of_a_lamp(self):
        watts = self.power("box.obj", *SMALL, *DARK, "--light", "point,900lm,at=.5,.5,.5", "-o", "a.h5")
        # Closed forms of all faces: rounding.
        np.testing.assert_allclose(watts, 900 / LUMENS, rtol=1e-12)
        two = self.power("box.obj", *SMALL, *DARK, "--light", "point,1W,at=.5,.5,.5", "--light",
                         "point,1,2,3W,at=.2,.2,.2", "-o", "b.h5")
        np.testing.assert_allclose(two, [2, 3, 4], rtol=1e-12)

    def test_a_results_file_keeps_them_and_takes_others(self):
        self.power("box.obj", *SMALL, *DARK, "--light", "point,1W,at=.5,.5,.5,name=My lamp", "-o", "a.h5")
        run = self.run_program("solve", "a.h5")
        self.assertIn("solution       reused", run.out)
        run = self.run_program("solve", "a.h5", "--set", "My lamp.intensity=3W")
        self.assertIn("form factors   reused", run.out)
        np.testing.assert_allclose(self.power("a.h5"), 3, rtol=1e-12)
        run = self.run_program("solve", "a.h5", "--without", "My lamp", "--light", "spot,5,at=.5,.9,.5,"
                               "aim=.5,0,.5,outer=20")
        self.assertIn("left out: My lamp", run.out)
        self.assertIn("spot: intensity 0 -> 5 W/sr at 0.5,0.9,0.5", run.out)
        (spot,) = self.lights_of("a.h5")
        self.assertEqual([spot["name"], spot["kind"], spot["strength"], spot["stands"]],
                         ["spot", "spot", "5, 5, 5 W/sr", "at 0.5, 0.9, 0.5"])

    def test_the_sun_stands_by_angles_or_by_place_and_time(self):
        self.write("floor.obj", "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\no floor\nf 1 2 3 4\n")
        watts = self.power("floor.obj", "--patches", "4", "--sun", "1000,elevation=30,azimuth=77", "-o", "s.h5")
        # The mean of a cosine over the disc of .533 degrees is 5e-6 less.
        np.testing.assert_allclose(watts, 500, rtol=1e-5)
        run = self.run_program("solve", "s.h5", "--set", "sun.elevation=90")
        self.assertIn("sun: irradiance 1000 -> 1000 W/m^2 90 degrees above the horizon, azimuth 77",
                      run.out)
        run = self.run_program("solve", "floor.obj", "--patches", "4", "--sun", "52.5,13.4,2026-06-21T11:08Z")
        self.assertIn("W/m^2 60.95 degrees above the horizon, azimuth 179.9", run.out)
        self.refuse("solve", "floor.obj", "--sun", "52.5,13.4,2026-06-21T23:00Z",
                    words=["sun: at 2026-06-21T23:00Z", "below the horizon", "give a time of day"])

    def test_blenders_lamps_are_its_own(self):
        sun, ceiling, reading = self.lights_of(DATA / "blender-lamps.glb")
        self.assertEqual([light["name"] for light in (sun, ceiling, reading)],
                         ["Sun", "Ceiling lamp", "Reading lamp"])
        # Watts and colours as they stand in Blender. The file has single precision.
        for light, given in [(sun["strength"].removesuffix(" W/m^2"), 20 * np.array([1, .95, .85])),
                             (ceiling["power_W"], 60 * np.array([1, .85, .7])),
                             (reading["power_W"], 15 * np.array([1, .8, .6]))]:
            np.testing.assert_allclose([float(x) for x in light.split(",")], given, rtol=1e-4)

    def test_gathering_and_elements_see_them(self):
        lamps = ["--light", "point,3W,at=.5,.5,.5"]
        self.run_program("compare", "box.obj", *DARK, *lamps, "--gather", *SMALL, "--at", "patches",
                         "--tolerance", "0.05")
        self.run_program("render", "box.obj", *SMALL, *DARK, *lamps, "--width", "16", "--height", "16", "-o",
                         "p.exr", "--final-gather")

    def test_each_lamp_is_a_source(self):
        self.run_program("solve", "box.obj", *SMALL, "--light", "point,1W,at=.5,.5,.5", "--basis", "surfaces",
                         "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as file:
            self.assertEqual(sorted(file["basis/names"].asstr()), ["ceiling/lamp", "point"])
        self.run_program("solve", "b.h5", "--mix", "point=2", "-o", "twice.csv")

    def test_what_is_no_lamp_is_refused(self):
        for text, words in [("lamp,1", ["--light: no light is called 'lamp'; there are sky, point"]),
                            ("point", ["--light point: '' is not one finite number or three"]),
                            ("point,1,at=0,0", ["--light point: at '0,0' is not X,Y,Z"]),
                            ("point,1,to=1", ["'to' is no parameter of it; there are intensity, name, at"]),
                            ("point,-1", ["--light: point intensity -1 is not a finite value"]),
                            ("spot,1,outer=200", ["--light: outer: 200 degrees is out of range"])]:
            with self.subTest(text):
                self.refuse("solve", "box.obj", "--light", text, words=words)

    def test_lamps_that_light_nothing_are_named(self):
        run = self.run_program("solve", "box.obj", *SMALL, "--light", "point,1,at=5,5,5")
        self.assertIn("point lights nothing: it stands in a body or behind surfaces", run.out)
        run = self.run_program("solve", "box.obj", *SMALL, *DARK, "--light", "point,1,at=5,5,5")
        self.assertIn("no light reaches a front", run.out + run.err)


if __name__ == "__main__":
    unittest.main()
