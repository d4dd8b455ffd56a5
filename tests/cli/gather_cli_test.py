"""radiosity gather: files, stage reuse, exit codes; the results read by h5py."""

import unittest

import h5py
import numpy as np

from cli_runner import CliTest

SMALL = ["--patches", "60", "--resolution", "32"]


class Gather(CliTest):
    def test_light_at_vertices_is_kept_in_a_results_file(self):
        report = self.report("gather", "box.obj", *SMALL, "--passes", "7", "-o", "g.h5")["gather"]
        self.assertEqual(report["at"], "vertices")
        self.assertEqual(len(report["passes"]), 7)
        with h5py.File(self.folder / "g.h5") as file:
            self.assertNotIn("form_factors", file)  # no matrix is stored
            group = file["gather"]
            self.assertEqual(group.attrs["at"].decode() if isinstance(group.attrs["at"], bytes)
                             else group.attrs["at"], "vertices")
            radiosity = group["radiosity"][:]
            self.assertEqual(radiosity.dtype, np.float32)
            self.assertEqual(radiosity.shape, (report["eyes"], 3))
            eyes = group["eye_of_corner"][:]
            self.assertEqual(len(eyes), len(file["mesh/corners"]))
            # Areas of the eyes are those of the patches: a unit cube.
            self.assertAlmostEqual(group["area"][:].sum(), 6, delta=1e-9)
            # Every eye stands at its vertex, moved by less than a patch.
            vertex = file["mesh/vertices"][:][file["mesh/corners"][:]]
            distance = np.linalg.norm(group["position"][:][eyes] - vertex, axis=1)
            self.assertLess(distance.max(), 0.1)
            self.assertEqual(group["summary/passes/emitted"].shape, (7, 3))

    def test_gathering_in_a_closed_box_equals_the_matrix_solution(self):
        # Same eyes: with as many bounces both methods have the same light, to float rounding and
        # the tolerances (1e-6 of max E each; the lamp's E is 5 pi).
        self.run_program("solve", "box.obj", *SMALL, "--method", "hemicube", "--emitters",
                         "estimated", "--solve-tolerance", "1e-7", "-o", "r.h5")
        report = self.report("gather", "r.h5", "--at", "patches", "--resolution", "32",
                             "--gather-tolerance", "1e-6")
        self.assertEqual(report["stages"]["mesh"]["action"], "reused")
        self.assertEqual(report["stages"]["solution"]["action"], "kept")
        with h5py.File(self.folder / "r.h5") as file:
            matrix = file["solution/radiosity"][:]
            gathered = file["gather/radiosity"][:]
        self.assertLess(np.abs(matrix - gathered).max(), 3e-6 * 5 * np.pi)

    def test_stage_is_reused_recomputed_and_dropped(self):
        self.run_program("gather", "box.obj", *SMALL, "-o", "g.h5")
        action = self.report("gather", "g.h5")["stages"]["gather"]["action"]
        self.assertEqual(action, "reused")
        action = self.report("gather", "g.h5", "--at", "patches")["stages"]["gather"]
        self.assertEqual(action["action"], "recomputed")
        self.assertIn("vertices -> patches", action["detail"])
        stages = self.report("solve", "g.h5", "--set", "wall.reflectance=.1")["stages"]
        self.assertEqual(stages["gather"]["action"], "dropped")

    def test_pictures_and_lit_mesh_show_the_gathered_light(self):
        # The gathered light through the renderer and the mesh writer of the matrix method: the same
        # room, as far as 60 patches and 32 pixels go (some per cent).
        view = ["--width", "48", "--samples", "2"]
        self.run_program("gather", "box.obj", *SMALL, *view, "-o", "g.png", "-o", "g.exr", "-o",
                         "g.glb", "-o", "g.h5")
        self.assertEqual((self.folder / "g.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.run_program("render", "box.obj", *SMALL, *view, "-o", "m.exr", "-o", "m.glb")
        pictures = self.report("compare", "g.exr", "m.exr")["comparison"]
        self.assertLess(pictures["relative_l2"], 0.1)
        self.assertGreater(pictures["relative_l2"], 1e-6)
        # Lit mesh and results file hold the same light: corners that are shared by patches with one
        # value each are floats in both, triangles are linear where quadrilaterals are bilinear.
        meshes = self.report("compare", "g.h5", "g.glb")["comparison"]
        self.assertEqual(meshes["matched_a"], "100.00%")
        self.assertLess(meshes["relative_l2"], 0.01)

    def test_pictures_reuse_light_gathered_before(self):
        self.run_program("gather", "box.obj", *SMALL, "-o", "g.h5")
        before = (self.folder / "g.h5").read_bytes()
        report = self.report("gather", "g.h5", "--width", "32", "-o", "p.exr")
        self.assertEqual(report["stages"]["gather"]["action"], "reused")
        self.assertEqual(report["picture"]["size"].split()[0], "32")
        # Light computed for the picture alone is not dropped silently.
        run = self.run_program("gather", "g.h5", "--at", "patches", "--width", "32", "-o", "q.exr")
        self.assertIn("g.h5 is left as it is", run.out)
        self.assertEqual((self.folder / "g.h5").read_bytes(), before)
        flat = self.run_program("gather", "g.h5", "--width", "32", "--flat", "-o", "f.exr")
        self.assertNotIn("left as it is", flat.out)
        self.assertGreater(self.report("compare", "p.exr", "f.exr")["comparison"]["relative_l2"], 0)

    def test_light_lost_on_backs_is_reported(self):
        # The ceiling turned over: it is dark, and its back is seen.
        text = (self.folder / "box.obj").read_text()
        self.write("lamp.obj", text.replace("f 1 2 3 4", "f 4 3 2 1"))
        run = self.run_program("gather", "lamp.obj", *SMALL)
        self.assertIn("lost on surfaces seen from behind: flipped? (room/wall)", run.err)
        self.assertNotIn("flipped", self.run_program("gather", "box.obj", *SMALL).err)

    def test_light_lost_between_eyes_is_reported(self):
        # A lamp a hundredth above the floor: no corner of the floor is in its light.
        self.write("low.obj", """mtllib box.mtl
v 0 0 0
v 0 0 1
v 1 0 1
v 1 0 0
v .4 .01 .4
v .6 .01 .4
v .6 .01 .6
v .4 .01 .6
o floor
usemtl wall
f 1 2 3 4
o lamp
usemtl lamp
f 5 6 7 8
""")
        large = ["--faces-as-patches", "--resolution", "32"]
        run = self.run_program("gather", "low.obj", *large, code=1)
        self.assertRegex(run.err, "energy does not balance: .* of the light is missing; not usable")
        self.assertIn("--patches", run.err)
        self.assertRegex(run.out, "usable +no")
        fine = self.run_program("gather", "low.obj", "--max-edge", "0.02", "--resolution", "32",
                                "--passes", "2")
        self.assertNotIn("balance", fine.err)

    def test_pictures_that_cannot_be_drawn_are_refused_first(self):
        self.refuse("gather", "box.obj", *SMALL, "-o", "g.png", "--camera", "attic",
                    words=["--camera", "attic"])
        self.refuse("gather", "box.obj", *SMALL, "-o", "g.png", "--exposure", "bright",
                    words=["--exposure", "bright"])
        self.refuse("gather", "box.obj", *SMALL, "-o", "g.mtx",
                    words=["g.mtx", ".png, .exr, .hdr, .glb, .h5"])

    def test_exit_codes_tell_failure_from_misuse(self):
        # White walls and a grey lamp: far from converged after 100 passes.
        white = ["--set", "wall.reflectance=1", "--set", "lamp.reflectance=0.999"]
        small = ["--patches", "6", "--resolution", "16"]
        run = self.run_program("gather", "box.obj", *small, *white, "--at", "patches", code=1)
        self.assertIn("allow more --passes", run.err)
        self.run_program("gather", "box.obj", *small, *white, "--at", "patches", "--passes", "100")
        run = self.run_program("gather", "box.obj", *small, "--set", "lamp.radiance=0")
        self.assertIn("nothing emits", run.err)
        for option, value in [("--passes", "0"), ("--gather-tolerance", "2"), ("--at", "edges"),
                              ("--resolution", "33"), ("--crease", "200")]:
            run = self.run_program("gather", "box.obj", option, value, code=2)
            self.assertIn(option, run.err)
        self.refuse("gather", "box.obj", "--tolerance", "1", words=["did you mean --gather-tol"])


if __name__ == "__main__":
    unittest.main()
