"""Results files whose materials have other bands than a scene's three, from solve to picture."""

import unittest

import h5py
import numpy as np

from cli_runner import SMALL, CliTest


class Bands(CliTest):
    def spectral(self, name, bands):
        """A results file of box.obj with form factors and materials of so many bands, which repeat
        those of the scene; and the scene's own light, which is still in it."""
        self.run_program("solve", "box.obj", *SMALL, "-o", name)
        with h5py.File(self.folder / name, "r+") as file:
            group = file["solution"]
            for values in ("reflectance", "emission"):
                rgb = group[values][()]
                del group[values]
                group[values] = np.tile(rgb, (1, 3))[:, :bands]
            group.attrs["sky"] = np.zeros(bands)
            return name, group["radiosity"][()]

    def light(self, name, stage="solution"):
        with h5py.File(self.folder / name) as file:
            return file[stage]["radiosity"][()]

    def test_solve_uses_the_bands_of_the_file(self):
        for bands in (1, 2, 5, 8):
            name, rgb = self.spectral("s.h5", bands)
            self.run_program("compare", name, name)  # the scene's light is still there
            report = self.report("solve", name)
            self.assertEqual(report["stages"]["form_factors"]["action"], "reused")
            self.assertEqual(len(report["solution"]["emitted_W"]), bands)
            # Sweeps go on until all bands are there: two solutions to 1e-6.
            np.testing.assert_allclose(self.light(name), np.tile(rgb, (1, 3))[:, :bands], rtol=1e-5)
            again = self.report("solve", name)
            self.assertEqual(again["stages"]["solution"]["action"], "reused")

    def test_output_names_the_bands(self):
        name, _ = self.spectral("s.h5", 8)
        self.assertIn("emitted (bands 1 to 8)", self.run_program("solve", name).out)
        self.assertIn("emitted (R G B)", self.run_program("solve", "box.obj", *SMALL).out)
        report = self.report("compare", name, name)["comparison"]
        self.assertEqual(len(report["relative_l2_bands"]), 8)
        self.assertIn("l2_band_8_percent", report["surfaces"][0])

    def test_gather_and_compare_use_the_bands_of_the_file(self):
        name, rgb = self.spectral("s.h5", 8)
        self.run_program("gather", name, "--at", "patches", "--resolution", "32",
                         "--gather-tolerance", "1e-6")
        self.assertEqual(self.light(name, "gather").shape, (len(rgb), 8))
        # The same hemicubes: rounding, and the light of passes beyond the tolerance.
        self.run_program("compare", name, "--gather", "--tolerance", "1e-5", "-o", "gap.png")
        self.run_program("solve", "box.obj", *SMALL, "-o", "rgb.h5")
        self.refuse("compare", name, "rgb.h5",
                    words=["s.h5 has 8 bands and rgb.h5 has 3 bands", "solve or gather both"])

    def test_factors_keep_the_materials(self):
        name, _ = self.spectral("s.h5", 5)
        self.run_program("factors", name, "--resolution", "64")
        with h5py.File(self.folder / name) as file:
            self.assertEqual(file["solution/reflectance"].shape[1], 5)

    def test_pictures_in_colour_take_three_bands_or_one(self):
        name, _ = self.spectral("s.h5", 8)
        for output, command in (("p.png", "render"), ("p.exr", "render"), ("p.glb", "solve"),
                                ("p.png", "gather")):
            self.refuse(command, name, "-o", output,
                        words=[output, "draws three bands", "s.h5 has 8",
                               "radiosity render s.h5 --show radiosity"])
        run = self.run_program("render", name, "--show", "radiosity", "-o", "sum.png", "--width", "64")
        self.assertIn("radiosity B (sum of all bands)", run.out)
        name, _ = self.spectral("heat.h5", 1)
        view = ["--camera", "eye=0.5,0.5,0.9;target=0.5,0.5,0", "--width", "64"]
        self.run_program("render", name, "-o", "grey.exr", "-o", "grey.glb", *view)
        self.run_program("render", "box.obj", *SMALL, "-o", "rgb.exr", *view)
        # Grey is the red of the picture in colours: that band differs by the solver's sweeps, and by the
        # noise (.3%) of the few points that take more rays for the sake of another band.
        report = self.report("compare", "grey.exr", "rgb.exr")["comparison"]
        self.assertLess(report["relative_l2_bands"][0], 5e-4)
        self.assertGreater(report["relative_l2_bands"][1], 0.01)

    def test_a_dark_file_is_warned_of_and_a_cure_is_named(self):
        name, _ = self.spectral("s.h5", 5)
        with h5py.File(self.folder / name, "r+") as file:
            file["solution/emission"][...] = 0
        run = self.run_program("solve", name)
        self.assertIn("nothing emits light, so B = 0 everywhere; give patches an emission above 0 in "
                      "/solution of s.h5", run.err)

    def test_options_that_conflict_with_the_bands_are_refused(self):
        name, _ = self.spectral("s.h5", 8)
        self.refuse("solve", name, "--set", "wall.reflectance=.5",
                    words=["s.h5: holds materials of 8 bands", "/solution"])
        self.refuse("solve", name, "--patches", "20",
                    words=["s.h5: holds materials of 8 bands", "another mesh"])


if __name__ == "__main__":
    unittest.main()
