"""Errors on the command line: messages, exit codes, and nothing half-written."""

import json
import os
import pty
import select
import shutil
import signal
import subprocess
import sys
import time
import unittest

import h5py

from cli_runner import DATA, PROGRAM, SMALL, CliTest, limit

# Minutes of work, so that a signal always finds it running.
LONG = ["--patches", "20000", "--method", "hemicube", "--resolution", "2048"]


class BadArguments(CliTest):
    def test_typos_get_a_suggestion(self):
        self.refuse("rendr", "box.obj", words=["rendr", "did you mean render?"])
        self.refuse("mesh", "box.obj", "--patchs", "5", words=["--patchs", "did you mean --patches?"])
        self.refuse("solve", "box.obj", "--solver", "jacoby", words=["--solver", "jacobi"])
        self.refuse("render", "box.obj", "-o", "p.png", "--show", "rowsum",
                    words=["--show", "did you mean row-sum?"])
        self.refuse("rend", "box.obj", words=["rend", "did you mean render?"])

    def test_another_thing_is_no_typo(self):
        line = self.refuse("factors", "box.obj", "--symmetry", words=["unknown option --symmetry"])
        self.assertNotIn("did you mean", line)
        self.refuse("so", "box.obj", words=["did you mean solve?"])
        self.refuse("re", "box.obj", words=["did you mean render?"])
        line = self.refuse("x", "box.obj", words=["not a subcommand"])
        self.assertNotIn("did you mean", line)

    def test_help_is_a_word_too(self):
        self.assertEqual(self.run_program("help").out, self.run_program("--help").out)
        for command in ["info", "render"]:
            self.assertEqual(self.run_program("help", command).out,
                             self.run_program(command, "--help").out)
        self.refuse("help", "rendr", words=["rendr", "did you mean render?"])

    def test_what_needs_no_scene_is_checked_before_one_is_read(self):
        # The scene is refused as soon as it is read, so the option's fault is found before.
        self.write("broken.obj", "v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n")
        self.refuse("info", "broken.obj", words=["broken.obj", "nan"])
        picture = ["render", "broken.obj", "-o", "p.png"]
        for arguments, word in [
                (["factors", "broken.obj", "--tolerance", "0"], "--tolerance"),
                (["factors", "broken.obj", "--resolution", "33"], "--resolution"),
                (["gather", "broken.obj", "--resolution", "8"], "--resolution"),
                (["gather", "broken.obj", "--passes", "0"], "--passes"),
                (["mesh", "broken.obj", "--weld", "1"], "--weld"),
                (["solve", "broken.obj", "--solve-tolerance", "2"], "--solve-tolerance"),
                (["solve", "broken.obj", "--memory-limit", "much"], "--memory-limit"),
                (["heat", "broken.obj", "--condition", "a.heat=3"], "a.heat=3"),
                (["heat", "broken.obj", "--condition", "a.flux=3", "--band-edges", "5,4"],
                 "--band-edges"),
                (["compare", "broken.obj", "--gather", "--match", "1"], "--match"),
                (["info", "broken.obj", "--max-image", "0"], "--max-image"),
                ([*picture, "--width", "0"], "--width"),
                ([*picture, "--samples", "17"], "--samples"),
                ([*picture, "--crease", "-1"], "--crease"),
                ([*picture, "--exposure", "x"], "--exposure"),
                ([*picture, "--element-tolerance", "2"], "--element-tolerance"),
                ([*picture, "--camera", "eye=1,2"], "--camera"),
                ([*picture, "--camera", "eye=1,2,3;target=1,2,3"], "--camera"),
                ([*picture, "--camera", "target=0,0,0"], "--camera"),
        ]:
            with self.subTest(arguments=arguments):
                self.assertNotIn("broken.obj:", self.refuse(*arguments, words=[word]))

    def test_missing_and_superfluous_arguments_are_refused(self):
        self.refuse(words=["subcommand"])
        self.refuse("info", words=["missing"])
        self.refuse("info", "box.obj", "box.mtl", words=["box.mtl"])
        self.refuse("render", "box.obj", words=["-o", ".png"])
        self.refuse("box.obj", words=["radiosity render box.obj"])

    def test_values_out_of_range_are_refused(self):
        for arguments, words in [
                (["mesh", "box.obj", "--patches", "0"], ["patches"]),
                (["mesh", "box.obj", "--patches", "-5"], ["--patches"]),
                (["mesh", "box.obj", "--patches", "many"], ["--patches", "many"]),
                (["mesh", "box.obj", "--weld", "0.5"], ["weld"]),
                (["mesh", "box.obj", "--max-edge", "nan"], ["max"]),
                (["mesh", "box.obj", "--patches", "5", "--max-edge", "1"], ["--max-edge"]),
                (["factors", "box.obj", "--resolution", "33"], ["resolution"]),
                (["factors", "box.obj", "--memory-limit", "2X"], ["--memory-limit", "2X"]),
                (["factors", "box.obj", "--tolerance", "0.5"], ["--tolerance", "0.5", "0.1"]),
                (["factors", "box.obj", "--tolerance", "nan"], ["--tolerance", "nan"]),
                (["factors", "box.obj", "--method", "exakt"], ["--method", "exakt"]),
                (["solve", "box.obj", "--solve-tolerance", "-1"], ["tolerance"]),
                (["solve", "box.obj", "--max-iterations", "0"], ["iterations"]),
                (["render", "box.obj", "-o", "p.png", "--width", "0"], ["width"]),
                (["render", "box.obj", "-o", "p.png", "--exposure", "bright"], ["--exposure"]),
                (["render", "box.obj", "-o", "p.png", "--exposure", "+-1"], ["--exposure", "+-1"]),
                (["render", "box.obj", "-o", "p.png", "--show", "form-factor:x"], ["patch number"]),
                (["info", "box.obj", "--unit", "ell"], ["--unit", "mm"]),
                (["info", "box.obj", "--default-reflectance", "2"], ["default-reflectance"]),
                (["info", "box.obj", "--default-reflectance", "1e999"],
                 ["--default-reflectance: `1e999` is not a number"]),
                (["info", "box.obj", "--default-reflectance", "nan"],
                 ["--default-reflectance: nan is out of range; 0 to 1"]),
        ]:
            with self.subTest(arguments=arguments):
                self.refuse(*arguments, words=words)

    def test_unknown_and_malformed_cameras_are_refused(self):
        for camera, word in [("kitchen", "kitchen"), ("eye=1,2;target=0,0,0", "eye")]:
            self.refuse("render", "box.obj", *SMALL, "-o", "p.png", "--camera", camera, "--quiet",
                        words=[word])

    def test_a_missing_patch_number_is_refused(self):
        self.refuse("render", "box.obj", *SMALL, "-o", "p.png", "--show", "form-factor:999999",
                    words=["999999", "0 to "])

    def test_element_options_without_a_matching_output_are_refused(self):
        for arguments, words in [
                (["solve", "box.obj", "--elements", "on"], ["nothing is written", "-o FILE.glb"]),
                (["solve", "box.obj", "--elements", "on", "-o", "f.mtx"],
                 ["--elements on: f.mtx holds no light at points", "-o FILE.h5"]),
                (["render", "box.obj", "--elements", "on", "--show", "row-sum", "-o", "p.png"],
                 ["--elements on: --show"]),
                (["render", "box.obj", "--elements", "on", "--flat", "-o", "p.png"],
                 ["--elements on: --flat"]),
                (["render", "box.obj", "--elements", "on", "--flat", "-o", "p.png", "-o", "p.h5"],
                 ["--elements on: --flat", "leave one of the two out"]),
                (["solve", "box.obj", "--element-tolerance", ".1", "-o", "f.h5"],
                 ["--element-tolerance", "add --elements on"]),
                (["render", "box.obj", "--element-tolerance", ".1", "--elements", "off", "-o",
                  "p.png"], ["--element-tolerance", "leave out --elements off"]),
                (["solve", "box.obj", "--elements", "maybe"], ["--elements", "maybe"]),
                (["solve", "box.obj", "--element-tolerance", "2", "-o", "p.glb"],
                 ["--element-tolerance", "0.5"]),
                (["render", "box.obj", "--visible-only", "-o", "p.png"],
                 ["--visible-only", "-o FILE.glb"]),
                (["render", "box.obj", "--visible-only", "--elements", "off", "-o", "p.glb"],
                 ["--visible-only", "no elements"]),
                (["render", "box.obj", "--visible-only", "--elements", "on", "-o", "p.glb", "-o",
                  "p.h5"], ["--visible-only", "leave out --elements on"]),
                (["factors", "box.obj", "--elements", "on"], ["--elements"])]:
            with self.subTest(arguments=arguments):
                self.refuse(*arguments, "--quiet", words=words)

    def test_impossible_outputs_are_refused(self):
        self.refuse("render", "box.obj", "-o", "p.jpg", words=["p.jpg", ".png", ".exr", ".h5"])
        self.refuse("mesh", "box.obj", "-o", "p.png", words=["p.png", ".obj", ".glb"])
        self.refuse("mesh", "box.obj", "-o", "box.obj", words=["box.obj"])
        self.refuse("mesh", "box.obj", "-o", "a.obj", "-o", "./a.obj", words=["twice"])
        self.refuse("mesh", "box.obj", "-o", "nowhere/a.obj", words=["nowhere"])
        self.refuse("mesh", "box.obj", "--report", "nowhere/r.json", words=["nowhere"])
        (self.folder / "folder.h5").mkdir()
        self.refuse("solve", "box.obj", *SMALL, "-o", "folder.h5", words=["folder"])


class BadInput(CliTest):
    def test_a_missing_file_is_named(self):
        self.refuse("info", "absent.obj", words=["absent.obj", "no such file"])
        self.refuse("render", "absent.h5", "-o", "p.png", words=["absent.h5"])

    def test_a_file_that_is_no_scene_is_refused(self):
        self.write("words.txt", "hello")
        self.refuse("info", "words.txt", words=["words.txt", ".obj"])

    def test_a_reflectance_above_one_is_refused(self):
        self.refuse("solve", "box.obj", *SMALL, "--set", "wall.reflectance=1.5",
                    words=["wall", "1.5"])
        self.write("box.mtl", "newmtl lamp\nKe 1 1 1\nnewmtl wall\nKd 0.5 1.25 0.5\n")
        self.refuse("solve", "box.obj", *SMALL, words=["wall", "1.25"])

    def test_an_unknown_material_gets_suggestions(self):
        self.refuse("solve", "box.obj", "--set", "wal.reflectance=.5", words=["wal", "wall", "lamp"])

    def test_a_scene_without_light_is_not_drawn_and_solves_to_zero(self):
        self.refuse("render", "box.obj", *SMALL, "--set", "lamp.radiance=0", "-o", "p.png",
                    words=["box.obj", "--set", "radiance="])
        run = self.run_program("solve", "box.obj", *SMALL, "--set", "lamp.radiance=0", "-o", "s.h5")
        self.assertIn("B = 0", run.err)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertEqual(abs(file["solution/radiosity"][()]).max(), 0)

    def test_a_damaged_results_file_is_refused(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        whole = (self.folder / "s.h5").read_bytes()
        (self.folder / "cut.h5").write_bytes(whole[:len(whole) // 2])
        self.refuse("solve", "cut.h5", words=["cut.h5"])
        shutil.copy(self.folder / "s.h5", self.folder / "hole.h5")
        with h5py.File(self.folder / "hole.h5", "a") as file:
            del file["mesh/area"]
        self.refuse("solve", "hole.h5", words=["hole.h5", "area"])
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["x"] = 1
        self.refuse("render", "foreign.h5", "-o", "p.png", words=["foreign.h5"])

    def test_text_and_empty_files_are_no_results_files(self):
        self.write("text.h5", "no HDF5\n")
        self.write("empty.h5", "")
        for name in ("text.h5", "empty.h5"):
            for command in (["info"], ["solve"], ["heat"], ["render", "-o", "p.png"]):
                self.refuse(command[0], name, *command[1:], words=[name, "is not a results file"])
            self.refuse("compare", name, "box.obj", words=[name, "is not a results file"])

    def test_another_programs_hdf5_is_not_replaced(self):
        with h5py.File(self.folder / "mine.h5", "w") as file:
            file["measured"] = [1.0, 2.0]
        before = (self.folder / "mine.h5").read_bytes()
        for command in ("mesh", "factors", "render"):
            self.refuse(command, "box.obj", *SMALL[:2], "-o", "mine.h5",
                        words=["mine.h5", "HDF5 file of another program", "another name"])
        self.assertEqual((self.folder / "mine.h5").read_bytes(), before)

    def test_results_of_another_scene_are_replaced_loudly(self):
        small = ["factors", *SMALL, "-o", "x.h5"]
        self.write("other.obj", (self.folder / "box.obj").read_text().replace("v 1 1 1", "v 1 1 2"))
        self.run_program(*small, "other.obj")
        run = self.run_program(*small, "box.obj", "--quiet")
        self.assertIn("WARNING: x.h5: holds results of other.obj", run.err)
        # A changed scene is the same scene.
        self.write("box.obj", (self.folder / "other.obj").read_text())
        self.assertEqual(self.run_program(*small, "box.obj").err, "")
        # Replacing those of another scene warns, too.
        self.run_program("factors", "other.obj", *SMALL, "-o", "y.h5")
        self.write("other.obj", (self.folder / "box.obj").read_text().replace("v 1 1 2", "v 1 1 3"))
        self.run_program("factors", "other.obj", *SMALL, "-o", "y.h5")
        run = self.run_program("factors", "x.h5", "-o", "y.h5")
        self.assertIn("WARNING: y.h5: holds results of other.obj", run.err)

    def test_files_of_the_scene_are_not_replaced(self):
        shutil.copy(DATA / "cornell-box.png", self.folder / "wall.png")
        self.write("box.mtl", "newmtl lamp\nKe 1 1 1\nnewmtl wall\nmap_Kd wall.png\n")
        before = {name: (self.folder / name).read_bytes() for name in ("wall.png", "box.mtl")}
        os.symlink("wall.png", self.folder / "link.png")
        for name in ("wall.png", "link.png"):
            self.refuse("render", "box.obj", *SMALL, "--quiet", "-o", name,
                        words=[name, "is a file of the scene box.obj", "another name"])
        self.refuse("solve", "box.obj", *SMALL, "--quiet", "--report", "box.mtl", words=["box.mtl", "is a file of the scene"])
        self.assertEqual(before, {name: (self.folder / name).read_bytes() for name in before})

    def test_reading_options_need_a_scene_file(self):
        self.run_program("mesh", "box.obj", *SMALL[:2], "-o", "m.h5")
        self.refuse("solve", "m.h5", "--unit", "mm", words=["--unit", "scene file"])

    def test_report_of_a_bad_run_is_not_written(self):
        self.refuse("info", "absent.obj", "--report", "r.json", words=["absent.obj"])


class FailedRuns(CliTest):
    def test_a_solution_that_did_not_converge_is_kept_marked(self):
        run = self.run_program("solve", "box.obj", *SMALL, "--max-iterations", "1", "-o", "s.h5",
                               "--report", "r.json", code=1)
        self.assertRegex(run.out, r"usable +no")
        self.assertIn("radiosity: ", run.err)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(report["exit_code"], 1)
        self.assertEqual(report["solution"]["status"], "no_convergence")
        # It is in the file, marked; a second run reports it again; more iterations cure it.
        self.run_program("solve", "s.h5", code=1)
        self.run_program("solve", "s.h5", "--max-iterations", "1000")

    def test_a_white_closed_room_is_singular(self):
        """rho = 1 everywhere in a closed room: energy only grows. The form factors are kept."""
        run = self.run_program("solve", "box.obj", *SMALL, "--set", "wall.reflectance=1", "--set",
                               "lamp.reflectance=1", "-o", "s.h5", code=1)
        self.assertIn("singular", run.out + run.err)
        with h5py.File(self.folder / "s.h5") as file:
            self.assertIn("form_factors", file)
        self.run_program("solve", "s.h5", "--set", "wall.reflectance=0.5")

    def test_a_memory_limit_refuses_with_the_numbers(self):
        # Quiet: on a busy machine planning takes long enough for a line of its own.
        line = self.refuse("factors", "box.obj", "--patches", "3000", "--memory-limit", "1M", "-o",
                           "f.h5", "--quiet", code=1)
        self.assertRegex(line, r"need about [\d.]+ MiB.*limit of 1\.0 MiB")
        self.run_program("factors", "box.obj", *SMALL, "--memory-limit", "1G")


class TimeLimit(CliTest):
    def test_form_factors_that_would_take_longer_are_refused_with_a_cure(self):
        line = self.refuse("factors", "box.obj", *LONG, "--time-limit", "60s", "-o", "f.h5",
                           "--quiet", code=1)
        self.assertRegex(line, r"form factors would take about .*, and --time-limit 1 min 0 s leaves "
                               r".* s; for less: ")

    def test_a_run_out_of_time_stops_and_writes_nothing(self):
        line = self.refuse("mesh", "box.obj", "--patches", "1000000", "--time-limit", "0.05", "-o",
                           "m.h5", "--quiet", code=1)
        self.assertEqual(line, "radiosity: stopped after 0.05 s, --time-limit; nothing was written")

    def test_enough_time_changes_nothing(self):
        self.run_program("factors", "box.obj", *SMALL, "--time-limit", "1h", "-o", "f.h5")

    def test_malformed_time_limits_are_refused(self):
        for text in ["0", "-1", "soon", "5x", "inf", "m"]:
            line = self.refuse("factors", "box.obj", f"--time-limit={text}")
            self.assertIn(f"--time-limit: '{text}' is not a time above 0", line)


class Interrupted(CliTest):
    def interrupt(self, process, number):
        process.send_signal(number)
        return process.communicate(timeout=limit(120))

    def start(self, *outputs):
        process = subprocess.Popen(
            [PROGRAM, "render", "box.obj", *LONG, *outputs, "--report", "r.json"],
            cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = ""
        while "hemicubes of" not in line:  # printed when form factors begin
            line = process.stdout.readline()
            self.assertTrue(line, "the run ended before it was interrupted")
        return process

    def test_signals_leave_nothing_behind(self):
        before = self.files()
        for number in [signal.SIGINT, signal.SIGTERM]:
            process = self.start("-o", "p.png", "-o", "p.exr")
            _, err = self.interrupt(process, number)
            self.assertEqual(process.returncode, 1, err)
            self.assertEqual(err.splitlines()[-1], "radiosity: interrupted; nothing was written")
            self.assertEqual(self.files(), before)

    def test_signals_leave_only_the_rows_of_a_results_file(self):
        before = self.files()
        rows = self.folder / "p.h5.rows"
        for number in [signal.SIGINT, signal.SIGTERM]:
            process = self.start("-o", "p.png", "-o", "p.h5")
            deadline = time.monotonic() + limit(120)
            while not rows.exists() or rows.stat().st_size < 8192:  # more than the header: a row
                self.assertLess(time.monotonic(), deadline)
                time.sleep(0.01)
            _, err = self.interrupt(process, number)
            self.assertEqual(process.returncode, 1, err)
            self.assertEqual(err.splitlines()[-1],
                             "radiosity: interrupted; p.h5.rows keeps the rows; the same command "
                             "goes on from them")
            rows.unlink()
            self.assertEqual(self.files(), before)

    def test_an_interrupted_update_leaves_the_old_results(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        before = (self.folder / "s.h5").read_bytes()
        process = subprocess.Popen([PROGRAM, "solve", "s.h5", *LONG], cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while "hemicubes of" not in process.stdout.readline():
            pass
        self.interrupt(process, signal.SIGINT)
        self.assertEqual(process.returncode, 1)
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)

    def test_a_terminal_gets_a_bar_with_the_time_left(self):
        leader, follower = pty.openpty()
        process = subprocess.Popen(
            [PROGRAM, "factors", "box.obj", *LONG], cwd=self.folder, stdout=subprocess.DEVNULL,
            stderr=follower, env={**os.environ, "TERM": "xterm"})
        os.close(follower)
        text = b""
        deadline = time.monotonic() + limit(120)
        while b"% " not in text or b" left" not in text:
            ready, _, _ = select.select([leader], [], [], 1)
            if ready:
                text += os.read(leader, 4096)
            self.assertIsNone(process.poll(), text)
            self.assertLess(time.monotonic(), deadline, text)
        process.send_signal(signal.SIGINT)
        process.wait(timeout=limit(120))
        os.close(leader)
        self.assertIn(b"\r", text)
        self.assertEqual(process.returncode, 1)


if __name__ == "__main__":
    sys.exit(unittest.main())
