"""Light on the command line: the sky, dark scenes, stages kept, requests that cannot be kept."""

import json
import shlex
import signal
import subprocess
import sys
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.sparse

from cli_runner import DATA, PROGRAM, SMALL, CliTest, limit

FLOOR = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\no floor\nf 4 3 2 1\n"


class Sky(CliTest):
    def test_a_floor_reflects_the_sky(self):
        self.write("floor.obj", FLOOR)
        report = self.report("solve", "floor.obj", "--patches", "9", "--sky", "1,2,0.5", "-o", "s.h5")
        with h5py.File(self.folder / "s.h5") as file:
            # rho = 0.5 where the file has no material; nothing but sky: rounding.
            np.testing.assert_allclose(file["solution/radiosity"][()],
                                       np.tile(0.5 * np.pi * np.array([1, 2, 0.5]), (9, 1)),
                                       rtol=1e-14)
            self.assertEqual(list(file["scene"].attrs["sky"]), [1, 2, 0.5])
        np.testing.assert_allclose(report["solution"]["from_sky_W"], np.pi * np.array([1, 2, 0.5]),
                                   rtol=1e-14)
        # It stays in the file; another sky is another solution with the same form factors.
        again = self.report("solve", "s.h5")
        self.assertEqual(again["stages"]["solution"]["action"], "reused")
        darker = self.report("solve", "s.h5", "--sky", "0.5")
        self.assertEqual(darker["stages"]["form_factors"]["action"], "reused")
        self.assertIn("sky 1,2,0.5 -> 0.5", darker["stages"]["solution"]["detail"])

    def test_pictures_show_the_sky(self):
        self.write("floor.obj", FLOOR)
        self.run_program("render", "floor.obj", "--sky", "2", "--patches", "9", "-o", "p.png",
                         "-o", "p.exr", "--camera", "eye=0.5,1,3;target=0.5,0.5,0", "--width", "64")
        self.run_program("gather", "floor.obj", "--sky", "2", "--patches", "9", "--resolution",
                         "64", "-o", "g.exr", "--camera", "eye=0.5,1,3;target=0.5,0.5,0",
                         "--width", "64")
        report = self.report("compare", "p.exr", "g.exr", "--tolerance", "1e-5")["comparison"]
        self.assertEqual(report["area_a"], 64 * 64)  # every pixel shows something: alpha 1

    def test_gathering_sees_the_same_sky(self):
        self.run_program("compare", DATA / "cornell-box.obj", "--sky", "1", "--gather", *SMALL,
                         "--at", "patches", "--gather-tolerance", "1e-6", "--tolerance", "5e-6")

    def test_a_closed_scene_does_not_see_the_sky(self):
        run = self.run_program("solve", "box.obj", *SMALL, "--set", "lamp.radiance=0", "--sky", "1",
                               "-o", "s.h5")
        self.assertIn("nothing emits light and no patch sees the sky (the scene is closed)", run.err)

    def test_a_sky_that_is_no_radiance_is_refused(self):
        self.refuse("solve", "box.obj", "--sky", "bright",
                    words=["--sky: 'bright' is not one finite number or three with commas"])
        self.refuse("solve", "box.obj", "--sky", "1,-2,3", words=["--sky: sky radiance -2 is not"])


class UpAxis(CliTest):
    def up(self, scene, *options):
        report = self.report("render", scene, "--sky", "1", "--patches", "100", "--width", "16",
                             "-o", "a.png", *options)
        return report["picture"]["up"]

    def test_engineers_files_stand_on_z_and_others_on_y(self):
        city = DATA / "city.stl"
        self.assertEqual(self.up(city), [0, 0, 1])
        self.assertEqual(self.up(city, "--up", "y"), [0, 1, 0])
        self.assertEqual(self.up(DATA / "facing-plates.obj", "--up", "z"), [0, 0, 1])
        self.assertEqual(self.report("info", city)["scene"]["up"], "z")

    def test_a_results_file_keeps_it_and_may_be_told_another(self):
        self.run_program("factors", DATA / "city.stl", "--patches", "100", "-o", "city.h5")
        self.assertEqual(self.up("city.h5"), [0, 0, 1])
        self.assertEqual(self.up("city.h5", "--up", "y"), [0, 1, 0])


class DarkScenes(CliTest):
    def test_both_cures_are_named_and_the_first_can_be_pasted(self):
        self.write("box.obj", (self.folder / "box.obj").read_text().replace("o room", "o my room"))
        line = self.refuse("render", "box.obj", *SMALL, "--set", "lamp.radiance=0", "-o", "p.png")
        self.assertEqual(line, "radiosity: box.obj: nothing in the scene emits light, so the picture "
                         f"would be black; make something a lamp: {PROGRAM} render box.obj "
                         f"{' '.join(SMALL)} --set lamp.radiance=0 -o p.png --set lamp.radiance=10 "
                         "(W/m^2/sr), or light an open scene from outside: --sky 1")
        pasted = line.split("make something a lamp: ")[1].split(" (W/m^2/sr)")[0]
        subprocess.run(shlex.split(pasted), cwd=self.folder, check=True, capture_output=True)
        self.assertTrue((self.folder / "p.png").exists())

    def test_a_view_of_unlit_surfaces_is_warned_of(self):
        # A camera in a second, dark room beside the lit one.
        dark = "".join(f"v {x + 3} {y} {z}\n" for x, y, z in
                       [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0), (0, 1, 0), (1, 1, 0), (1, 1, 1),
                        (0, 1, 1)])
        faces = "".join(f"f {' '.join(str(int(v) + 8) for v in face.split())}\n" for face in
                        ["1 2 3 4", "1 4 6 5", "2 8 7 3", "1 5 8 2", "4 3 7 6", "5 6 7 8"])
        self.write("box.obj", (self.folder / "box.obj").read_text() + dark +
                   "o dark\nusemtl wall\n" + faces)
        camera = ["--camera", "eye=3.1,0.5,0.5;target=4,0.5,0.5"]
        run = self.run_program("render", "box.obj", "--patches", "100", *camera, "-o", "p.png")
        self.assertIn("radiosity: warning: nothing lit is in view", run.err)
        # The default camera is in the lit room.
        run = self.run_program("render", "box.obj", "--patches", "100", "-o", "p.png")
        self.assertNotIn("nothing lit", run.err)


class KeptStages(CliTest):
    """A Ctrl-C loses no form factors."""

    def interrupt(self, arguments, after):
        process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        line = ""
        while not line.startswith(after):
            line = process.stdout.readline()
            self.assertTrue(line, "the run ended before it was interrupted")
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=limit(120))
        self.assertEqual(process.returncode, 1, err)
        return err.splitlines()[-1]

    def test_an_interrupted_solve_keeps_the_form_factors(self):
        # The room is so bright and sweeps so slow that a signal finds it at work.
        slow = ["--set", "wall.reflectance=0.9999999", "--set", "lamp.reflectance=0.9999999",
                "--solver", "jacobi", "--max-iterations", "100000000"]
        line = self.interrupt(["render", "box.obj", "--patches", "1500", *slow, "-o", "p.png",
                               "-o", "p.h5"], after="kept ")
        self.assertEqual(line, "radiosity: interrupted; p.h5 keeps the form factors")
        self.assertEqual(self.files(), ["box.mtl", "box.obj", "p.h5"])
        # So bright a room balances no energy, for rows sum to 1 only to the tolerance.
        report = self.report("solve", "p.h5", "--solver", "auto", "--max-iterations", "1000",
                             "--set", "wall.reflectance=0.5", "--set", "lamp.reflectance=0.5")
        self.assertEqual(report["stages"]["form_factors"]["action"], "reused")
        self.assertEqual(report["solution"]["status"], "converged")

    def test_an_interrupted_picture_keeps_the_solution(self):
        picture = ["--width", "8000", "--height", "8000", "--samples", "8"]
        line = self.interrupt(["render", "box.obj", *SMALL, *picture, "-o", "p.png", "-o", "p.h5"],
                              after="Picture")
        self.assertEqual(line,
                         "radiosity: interrupted; p.h5 keeps the form factors and the solution")
        self.assertEqual(self.files(), ["box.mtl", "box.obj", "p.h5"])
        report = self.report("render", "p.h5", "-o", "p.png")
        self.assertEqual(report["stages"]["solution"]["action"], "reused")

    def test_a_given_results_file_gets_missing_stages_and_keeps_others(self):
        self.run_program("mesh", "box.obj", *SMALL[:2], "-o", "m.h5")
        self.run_program("render", "m.h5", *SMALL[2:], "-o", "p.png")
        with h5py.File(self.folder / "m.h5") as file:
            self.assertIn("form_factors", file)
            self.assertIn("radiosity", file["solution"])
        before = (self.folder / "m.h5").read_bytes()
        for change in [["--set", "wall.reflectance=0.1"], ["--resolution", "64"]]:
            run = self.run_program("render", "m.h5", *change, "-o", "p.png")
            self.assertIn("m.h5 is left as it is", run.out)
            self.assertEqual((self.folder / "m.h5").read_bytes(), before)


class WhatCannotBeKept(CliTest):
    def test_more_planar_pieces_than_patches_asked_for_are_noted(self):
        # Six planar polygons of two surfaces: one patch each.
        run = self.run_program("solve", "box.obj", "--patches", "4", "-o", "s.h5")
        self.assertEqual(run.err, "")
        self.assertIn("6 patches: 4 were asked for, but there are 6 planar pieces", run.out)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(list(file["form_factors/shape"]), [6, 6])
            self.assertEqual(file["solution/radiosity"].shape, (6, 3))
        self.assertNotIn("were asked for", self.run_program("factors", "box.obj", "--patches", "6").out)
        self.run_program("factors", "s.h5", "-o", "f.mtx")
        self.assertEqual(scipy.io.mmread(self.folder / "f.mtx").shape, (6, 6))

    def test_a_matrix_market_file_holds_the_values_of_the_results_file(self):
        # Exact form factors are stored once a pair; closed, their rows sum to 1 in either file.
        self.run_program("factors", DATA / "cornell-box-closed.obj", "--patches", "150",
                         "--closure", "enforce", "-o", "f.h5", "-o", "f.mtx")
        with h5py.File(self.folder / "f.h5") as file:
            g = file["form_factors"]
            stored = scipy.sparse.csr_matrix(
                (g["data"][()].astype(float), g["indices"], g["indptr"]), g["shape"][()])
        text = scipy.io.mmread(self.folder / "f.mtx").tocsr()
        self.assertEqual(abs(stored - text).max(), 0)
        # Values that add up to 1, each rounded to 24 bits on the way to either place.
        self.assertLess(abs(stored.sum(axis=1) - 1).max(), 2 * 2**-24)


class CompareHeadline(CliTest):
    def test_the_headline_names_the_error_without_emitters_and_the_worst_surface(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "r.h5")
        self.run_program("solve", "box.obj", *SMALL, "--set", "wall.reflectance=.4", "-o", "s.h5")
        run = self.run_program("compare", "r.h5", "s.h5", "--report", "c.json")
        c = json.loads((self.folder / "c.json").read_text())["comparison"]
        lines = run.out.splitlines()
        headline = lines[lines.index("Comparison") + 1]
        self.assertRegex(headline, r"^  relative L2 difference +[\d.]+ \(without emitters [\d.]+; "
                         r"worst surface room/wall: [\d.]+\)$")
        self.assertGreater(c["relative_l2_without_emitters"], 2 * c["relative_l2"])
        # Walls alone do not emit here: both figures are theirs.
        self.assertEqual(c["worst_surface"], "room/wall")
        self.assertAlmostEqual(c["worst_surface_l2"], c["relative_l2_without_emitters"], delta=1e-12)

    def test_where_a_is_dark_nothing_is_relative_to_it(self):
        # Black walls send nothing back; what B sends is no number of times that.
        self.run_program("solve", "box.obj", *SMALL, "--set", "wall.reflectance=0", "-o", "r.h5")
        self.run_program("solve", "box.obj", *SMALL, "--set", "wall.reflectance=.4", "-o", "s.h5")
        run = self.run_program("compare", "r.h5", "s.h5", "--report", "c.json")
        self.assertNotRegex(run.out, r"\binf\b")
        self.assertRegex(run.out, r"relative L2 difference +[\d.]+ \(without emitters A is 0; "
                         r"worst surface ceiling/lamp: [\d.]+\)\n")
        c = json.loads((self.folder / "c.json").read_text())["comparison"]
        self.assertEqual(c["relative_l2_without_emitters"], "A is 0")
        walls = next(row for row in c["surfaces"] if row["name"] == "room/wall")
        self.assertEqual(walls["l2_percent"], "A is 0")
        self.assertEqual(c["largest_on"], "room/wall")


if __name__ == "__main__":
    sys.exit(unittest.main())
