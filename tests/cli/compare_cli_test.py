"""radiosity compare: units are said, never guessed; exit codes; pictures of the difference."""

import shutil
import unittest

import numpy as np

from cli_runner import DATA, CliTest
from exr_file import write_exr

SMALL = ["--patches", "60", "--method", "hemicube", "--resolution", "32", "--emitters", "estimated"]


class Compare(CliTest):
    def solved(self, name="r.h5", *more):
        self.run_program("solve", "box.obj", *SMALL, *more, "-o", name)
        return name

    def lit(self, colour):
        """The ceiling alone, coloured, as another program would write it."""
        return "".join(f"v {x} 1 {z} {colour}\n" for x, z in [(0, 0), (1, 0), (1, 1), (0, 1)]) + \
            "f 1 2 3 4\n"

    def refuse(self, *arguments, words):
        error = self.run_program("compare", *arguments, code=2).err
        self.assertEqual(len(error.strip().splitlines()), 1, error)
        for word in words:
            self.assertIn(word, error)

    def test_a_file_equals_itself(self):
        self.solved()
        report = self.report("compare", "r.h5", "r.h5", "--tolerance", "0")["comparison"]
        self.assertEqual(report["relative_l2"], 0)
        self.assertEqual(report["matched_a"], "100.00%")
        self.assertEqual(report["verdict"], "within the tolerance of 0")

    def test_tolerance_sets_the_exit_code(self):
        self.solved()
        self.solved("s.h5", "--set", "wall.reflectance=.4")
        report = self.report("compare", "r.h5", "s.h5")["comparison"]
        self.assertGreater(report["relative_l2"], 0.01)
        self.run_program("compare", "r.h5", "s.h5", "--tolerance", "1e-3", code=1)
        self.run_program("compare", "r.h5", "s.h5", "--tolerance", "1")
        surfaces = {row["name"]: row for row in report["surfaces"]}
        self.assertEqual(set(surfaces), {"room/wall", "ceiling/lamp"})
        self.assertGreater(surfaces["room/wall"]["l2_percent"],
                           surfaces["ceiling/lamp"]["l2_percent"])
        self.assertEqual(report["largest_on"], "room/wall")

    def test_gather_compares_a_scene_file_in_one_run(self):
        # The lit box, scene file in, difference out; results are kept on request.
        report = self.report("compare", "box.obj", "--gather", *SMALL, "-o", "gap.png", "-o",
                             "both.h5")
        self.assertLess(report["comparison"]["relative_l2"], 0.05)
        self.assertIn("points", report["comparison"]["gap"])
        self.assertEqual((self.folder / "gap.png").read_bytes()[:4], b"\x89PNG")
        again = self.report("compare", "both.h5", "--gather")
        for stage in ["mesh", "form_factors", "solution", "gather"]:
            self.assertEqual(again["stages"][stage]["action"], "reused", stage)
        self.assertEqual(again["comparison"]["relative_l2"], report["comparison"]["relative_l2"])
        # At patches, by the same hemicubes: the same light, but for tolerances and floats.
        report = self.report("compare", "both.h5", "--gather", "--at", "patches", "--resolution",
                             "32", "--gather-tolerance", "1e-6")
        self.assertLess(report["comparison"]["relative_l2"], 3e-6)

    def test_units_are_never_guessed(self):
        self.solved()
        self.write("lit.obj", self.lit("5 4 3"))
        self.refuse("r.h5", "lit.obj", words=["lit.obj", "--b-is"])
        self.refuse("r.h5", "lit.obj", "--a-is", "radiance", "--b-is", "radiance",
                    words=["r.h5", "--a-is"])
        self.refuse("r.h5", "lit.obj", "--b-is", "radiance", words=["--partial", "99%"])
        # The ceiling's Ke is 5 4 3 and it reflects a fifth of what falls on it.
        run = self.report("compare", "r.h5", "lit.obj", "--b-is", "radiance", "--partial")
        self.assertEqual(run["comparison"]["matched_b"], "100.00%")
        np.testing.assert_allclose(run["comparison"]["energy_b"], np.pi * np.array([5, 4, 3]),
                                   rtol=1e-3)
        run = self.run_program("compare", "r.h5", "lit.obj", "--b-is", "radiosity", "--partial")
        self.assertIn("that is pi", run.err)

    def test_pictures_are_compared_pixel_by_pixel(self):
        self.solved()
        view = ["--width", "96", "--height", "64"]
        self.run_program("render", "r.h5", *view, "-o", "a.exr", "-o", "a.png", "--exposure", "0")
        self.run_program("render", "r.h5", *view, "--samples", "1", "-o", "b.exr", "-o", "b.png",
                         "--exposure", "0")
        report = self.report("compare", "a.exr", "b.exr", "-o", "d.png")["comparison"]
        self.assertLess(report["relative_l2"], 0.2)
        self.assertEqual((self.folder / "d.png").read_bytes()[:4], b"\x89PNG")
        self.report("compare", "a.png", "b.png")
        self.refuse("a.png", "b.exr", words=["tone-mapped", ".exr", "--fit-scale"])
        self.refuse("a.exr", "r.h5", words=["a.exr", "picture", "render"])
        self.run_program("render", "r.h5", "--width", "64", "--height", "64", "-o", "c.exr")
        self.refuse("a.exr", "c.exr", words=["96 x 64", "64 x 64"])

    def test_sides_that_cannot_be_compared_are_refused(self):
        self.solved()
        self.refuse("r.h5", words=["B is missing", "--gather"])
        self.refuse("r.h5", "r.h5", "--gather", words=["one too many"])
        self.refuse("r.h5", "gone.ply", words=["gone.ply", "no such file"])
        self.refuse("r.h5", "box.obj", "--b-is", "radiance", words=["box.obj", "bake"])
        self.refuse("r.h5", "r.h5", "-o", "x.h5", words=["x.h5", "--gather"])
        self.refuse("r.h5", "r.h5", "--match", "2", words=["--match"])
        self.refuse("r.h5", "r.h5", "--tolerance", "-1", words=["--tolerance: '-1'", "from 0"])
        self.refuse(words=["A and B are missing", "--gather"])
        self.run_program("mesh", "box.obj", "--patches", "60", "-o", "m.h5")
        self.refuse("m.h5", "r.h5", words=["m.h5", "no light"])
        shutil.copy(DATA / "cornell-box-cycles.ply", self.folder / "other.ply")
        self.refuse("r.h5", "other.ply", "--b-is", "radiance", words=["not the same surfaces"])
        self.assertNotIn("d.png", self.files())

    def test_options_without_effect_are_refused(self):
        # Two files are compared as they are: options of meshing and light need --gather.
        self.solved()
        for option in [("--patches", "60"), ("--set", "wall.reflectance=.1"), ("--unit", "mm"),
                       ("--resolution", "32"), ("--solver", "jacobi"), ("--passes", "3"),
                       ("--symmetrize",)]:
            self.refuse("r.h5", "r.h5", *option, words=[option[0], "--gather"])
        self.refuse("box.obj", "--gather", "--b-is", "radiance", words=["--b-is", "--gather"])
        self.run_program("render", "r.h5", "--width", "32", "-o", "a.exr")
        for option in [("--camera", "x"), ("--width", "9"), ("--match", "0.01"), ("--partial",)]:
            self.refuse("a.exr", "a.exr", *option, words=[option[0], "pictures"])

    def test_pictures_of_other_renderers(self):
        """R, G and B in 16 or 32 bits, in any company: depth that comes fourth is no alpha."""
        light = np.linspace(.25, 2, 32 * 32).reshape(32, 32)
        full = {name: light.astype(np.float32) for name in "RGBA"}
        full["A"][:] = 1
        write_exr(self.folder / "a.exr", full)
        half = {name: light.astype(np.float16) for name in "RGB"}
        half["depth.Z"] = np.zeros((32, 32), np.float16)
        half["Albedo.R"] = np.full((32, 32), .5, np.float16)
        write_exr(self.folder / "b.exr", half)
        report = self.report("compare", "a.exr", "b.exr", "--a-is", "radiance", "--b-is", "radiance",
                             "--perceived")["comparison"]
        self.assertEqual(report["cells"], 1024)
        self.assertLess(report["relative_l2"], 3e-4)  # 11 bits
        self.assertLess(report["flip"], 1e-2)
        self.assertGreater(report["ssim"], .9999)
        double = {name: np.repeat(np.repeat(full[name], 2, 0), 2, 1) for name in full}
        write_exr(self.folder / "c.exr", double)
        run = self.run_program("compare", "c.exr", "a.exr", "--a-is", "radiance", "--b-is", "radiance", "-o", "d.png")
        self.assertIn("A was resampled: means of 2 x 2 of its 64 x 64 pixels", run.out + run.err)
        self.solved()
        self.refuse("r.h5", "r.h5", "--perceived", words=["--perceived", "pictures"])

    def test_the_gap_names_the_dominant_cause(self):
        few = self.report("compare", "box.obj", "--gather", *SMALL, "--passes", "1")["comparison"]
        self.assertIn("after pass 1", few["gap"])
        self.assertGreater(few["relative_l2"], 0.05)
        all_of_it = self.report("compare", "box.obj", "--gather", *SMALL)["comparison"]
        self.assertNotIn("after pass", all_of_it["gap"])


if __name__ == "__main__":
    unittest.main()
