"""--eye on the command line: devices that draw hemicubes."""

import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))

from cli_runner import SMALL, CliTest  # noqa: E402


def relative_difference(a, b):
    return np.linalg.norm(a - b) / np.linalg.norm(a)


class EyeTest(CliTest):
    def test_devices_are_listed_without_a_scene(self):
        said = self.run_program("info", "--devices").out
        self.assertIn("OpenGL", said)
        self.assertRegex(said, "hardware|software")
        self.assertIn("excludes", self.run_program("info", "box.obj", "--devices", code=2).err)
        self.assertIn("is missing", self.run_program("info", code=2).err)

    def test_another_eye_recomputes_form_factors(self):
        self.run_program("factors", "box.obj", *SMALL, "-o", "f.h5")
        stage = self.report("factors", "f.h5", "--eye", "gl")["stages"]["form_factors"]
        self.assertEqual(stage["action"], "recomputed")
        self.assertIn("eye default -> gl", stage["detail"])
        report = self.report("factors", "f.h5")
        self.assertEqual(report["stages"]["form_factors"]["action"], "reused")
        self.assertTrue(report["form_factors"]["closed"])
        stage = self.report("factors", "f.h5", "--eye", "cpu")["stages"]["form_factors"]
        self.assertEqual(stage["action"], "recomputed")

    def test_gathered_light_equals_the_processors(self):
        # Few of the 3,072 pixels of an eye lie at an edge; those that differ, of a weight of 1e-3 or
        # less, show another surface, of about the same brightness but for the lamp.
        for at in ("patches", "vertices"):
            light = {}
            for eye in ("cpu", "gl"):
                self.run_program("gather", "box.obj", "--patches", 24, "--resolution", 32, "--at", at,
                                 "--passes", 3, "--eye", eye, "-o", f"{at}-{eye}.h5")
                with h5py.File(self.folder / f"{at}-{eye}.h5") as file:
                    light[eye] = file["gather/radiosity"][:]
            self.assertLess(relative_difference(light["cpu"], light["gl"]), 2e-3)
            self.assertGreater(np.abs(light["cpu"]).max(), 1)


if __name__ == "__main__":
    unittest.main()
