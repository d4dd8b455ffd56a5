"""Runs that are killed go on from the rows they have kept: the results have the same bits as those
of a run in one go."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py

from cli_runner import DATA, PATIENCE, PROGRAM, CliTest, limit

SCENE = str(DATA / "cluttered.obj")
# Each takes two or three seconds of one core.
METHODS = {
    "exact": ["--method", "exact", "--patches", "300", "--tolerance", "0.05"],
    "rays": ["--method", "rays", "--patches", "300", "--tolerance", "0.02"],
    "hemicube": ["--method", "hemicube", "--patches", "400", "--resolution", "384"],
}
# A longer run, for tests that do not wait for its end.
LONG = ["--method", "rays", "--patches", "900", "--tolerance", "0.0005"]


class ResumeTest(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.kept_folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.kept_folder.cleanup)
        cls.journal_sizes = {}

    def command(self, options, output="f.h5"):
        # --resume: rows are kept however short the run is foreseen to be.
        return ["factors", SCENE, *options, "--threads", "2", "--resume", "-o", output]

    def start(self, options):
        return subprocess.Popen([PROGRAM, *self.command(options)], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def kept_bytes(self):
        try:
            return (self.folder / "f.h5.rows").stat().st_size
        except FileNotFoundError:
            return 0

    def run_until(self, options, size):
        """Starts a run and returns it once its journal has that size, or None if it ended
        before."""
        process = self.start(options)
        while process.poll() is None and self.kept_bytes() < size:
            time.sleep(0.002)
        if process.poll() is not None:
            process.communicate()
            return None
        return process

    def kill_at(self, options, size):
        process = self.run_until(options, size)
        if process is None:
            return False
        process.send_signal(signal.SIGKILL)
        process.communicate()
        return self.kept_bytes() >= size

    def whole_run(self, method):
        """Leaves the factors of a run in one go in whole.h5; returns about the size of its whole
        journal. Runs once a method for all tests."""
        kept = f"{self.kept_folder.name}/{method}.h5"
        if method not in self.journal_sizes:
            self.journal_sizes[method] = self.journal_size(METHODS[method])
            os.replace(self.folder / "f.h5", kept)
        shutil.copy(kept, self.folder / "whole.h5")
        return self.journal_sizes[method]

    def journal_size(self, options):
        process = self.start(options)
        largest = 0
        while process.poll() is None:
            largest = max(largest, self.kept_bytes())
            time.sleep(0.002)
        process.communicate()
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.kept_bytes(), 0, "the journal goes when the results are written")
        return largest

    def assert_same_factors(self, first, second):
        super().assert_same_factors(first, second)
        with h5py.File(self.folder / first) as a, h5py.File(self.folder / second) as b:
            self.assertEqual(a["form_factors"].attrs["key"], b["form_factors"].attrs["key"])

    def test_killed_runs_resume_to_the_same_bits(self):
        for method, options in METHODS.items():
            with self.subTest(method):
                size = self.whole_run(method)
                kills = sum(self.kill_at(options, share * size) for share in
                            [0.001, 0.2, 0.4, 0.6, 0.8])
                # Fewer kills if a run ends before its file size is read.
                self.assertGreaterEqual(kills, 2)
                self.assertFalse((self.folder / "f.h5").exists())
                run = self.run_program(*self.command(options))
                self.assertRegex(run.out, r"rows +resumed: [1-9][\d,]* of [\d,]+ rows were there")
                self.assert_same_factors("whole.h5", "f.h5")
                self.assertNotIn("f.h5.rows", self.files())
                os.remove(self.folder / "f.h5")

    def test_damage_costs_the_damaged_blocks_alone(self):
        options = METHODS["hemicube"]
        size = self.whole_run("hemicube")
        self.assertTrue(self.kill_at(options, 0.5 * size))
        journal = self.folder / "f.h5.rows"
        content = bytearray(journal.read_bytes())
        content[len(content) // 2] ^= 1
        journal.write_bytes(content[:-5])
        run = self.run_program(*self.command(options))
        self.assertRegex(run.out, r"rows were there, [12] damaged blocks? left out")
        self.assert_same_factors("whole.h5", "f.h5")

    def test_other_options_start_afresh(self):
        self.whole_run("hemicube")
        self.assertTrue(self.kill_at(LONG, 20_000))
        options = METHODS["hemicube"]
        run = self.run_program(*self.command(options))
        self.assertIn("f.h5.rows held those of other form factors; removed", run.out)
        self.assertNotIn("resumed", run.out)
        self.assert_same_factors("whole.h5", "f.h5")
        self.assertNotIn("f.h5.rows", self.files())

    def test_no_resume_starts_afresh(self):
        options = METHODS["hemicube"]
        size = self.whole_run("hemicube")
        self.assertTrue(self.kill_at(options, 0.5 * size))
        run = self.run_program("factors", SCENE, *options, "--no-resume", "-o", "f.h5")
        self.assertNotIn("resumed", run.out)
        self.assert_same_factors("whole.h5", "f.h5")
        self.assertNotIn("f.h5.rows", self.files())

    def test_auto_resumes_with_the_method_of_the_rows(self):
        # Exact form factors of this scene take no time, but rows of rays are kept.
        options = ["--patches", "300", "--tolerance", "0.002"]
        box = str(DATA / "cornell-box-closed.obj")
        chosen = self.run_program("factors", box, *options, "-o", "auto.h5")
        self.assertIn("exact between", chosen.out)
        process = subprocess.Popen(
            [PROGRAM, "factors", box, *options, "--method", "rays", "--resume", "-o", "f.h5"],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and self.kept_bytes() < 20_000:
            time.sleep(0.002)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGKILL)
        process.wait()
        run = self.run_program("factors", box, *options, "-o", "f.h5")
        self.assertIn("rays between", run.out)
        self.assertIn("because rows of an earlier run are there", run.out)
        self.assertIn("resumed: ", run.out)

    def test_two_runs_do_not_mix(self):
        self.whole_run("hemicube")
        first = self.run_until(LONG, 20_000)
        self.assertIsNotNone(first)
        self.addCleanup(first.stdout.close)
        self.addCleanup(first.stderr.close)
        self.addCleanup(first.wait)
        self.addCleanup(first.kill)
        options = METHODS["hemicube"]
        run = self.run_program(*self.command(options))
        self.assertIn("are not kept: f.h5.rows is in use by another run", run.out)
        self.assertIsNone(first.poll())
        self.assertIn("f.h5.rows", self.files())
        self.assert_same_factors("whole.h5", "f.h5")

    def test_an_interrupted_run_names_the_file_of_its_rows(self):
        process = self.run_until(LONG, 20_000)
        self.assertIsNotNone(process)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=limit(60))
        self.assertEqual(process.returncode, 1)
        self.assertEqual(err.splitlines()[-1],
                         "radiosity: interrupted; f.h5.rows keeps the rows; the same command goes "
                         "on from them")
        self.assertIn("f.h5.rows", self.files())

    @unittest.skipIf(PATIENCE > 1, "no run is short under a sanitizer")
    def test_short_runs_keep_no_rows(self):
        process = subprocess.Popen(
            [PROGRAM, "factors", SCENE, *METHODS["hemicube"], "-o", "f.h5"],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None:
            self.assertEqual(self.kept_bytes(), 0)
            time.sleep(0.01)
        self.assertEqual(process.returncode, 0)

    def test_a_foreign_file_stays(self):
        self.write("f.h5.rows", "mine\n" * 20)
        run = self.run_program(*self.command(METHODS["hemicube"]))
        self.assertIn("are not kept: f.h5.rows is there and holds no rows", run.out)
        self.assertEqual((self.folder / "f.h5.rows").read_text(), "mine\n" * 20)


if __name__ == "__main__":
    sys.exit(unittest.main())
