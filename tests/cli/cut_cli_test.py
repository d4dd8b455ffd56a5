"""Form factors without pairs, from the command line: kept, resumed, solved, and refused where pairs are
needed."""

import os
import re
import signal
import subprocess
import time
import unittest

import h5py
import numpy as np

from cli_runner import DATA, PROGRAM, CliTest

SCENE = str(DATA / "cornell-box-closed.obj")
CUT = ["--patches", "600", "--method", "cut", "--tolerance", "0.02"]


class CutCliTest(CliTest):
    def solution(self, file):
        with h5py.File(self.folder / file) as f:
            return f["solution/radiosity"][:], f["mesh/area"][:]

    def test_solves_as_exact_form_factors_do(self):
        run = self.run_program("solve", SCENE, *CUT, "-o", "cut.h5")
        self.assertRegex(run.out, r"cut between [\d,]+ patches to 0\.0\d+")
        stated = float(re.search(r"irradiance off by about +([\d.e-]+)", run.out)[1])
        self.assertLess(stated, 0.03)
        self.run_program("solve", SCENE, "--patches", "600", "--method", "exact", "-o", "exact.h5")
        found, area = self.solution("cut.h5")
        right, _ = self.solution("exact.h5")
        weights = area[:, None]
        error = np.sqrt((weights * (found - right) ** 2).sum() / (weights * right**2).sum())
        # B is emission, which has no error, and a reflectance below 1 times irradiance.
        self.assertLess(error, stated)
        self.assertGreaterEqual(found.min(), 0)

    def test_is_read_back_and_solved_with_other_light(self):
        self.run_program("factors", SCENE, *CUT, "-o", "cut.h5")
        run = self.run_program("solve", "cut.h5", "--set", "all.reflectance=0.3")
        self.assertIn("form factors   reused from cut.h5", run.out)
        self.assertIn("usable", run.out)

    def test_goes_on_after_it_was_killed(self):
        # Rows that take a second or two, so that a busy machine, too, sees the first before the last.
        command = ["factors", SCENE, "--patches", "4000", *CUT[2:4], "--tolerance", "0.002", "--resume",
                   "--threads", "1"]
        self.run_program(*command, "-o", "whole.h5")
        process = subprocess.Popen([PROGRAM, *command, "-o", "f.h5"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        rows = self.folder / "f.h5.rows"
        while process.poll() is None and not (rows.exists() and rows.stat().st_size > 50_000):
            time.sleep(0.002)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGKILL)
        process.wait()
        run = self.run_program(*command, "-o", "f.h5")
        self.assertRegex(run.out, r"resumed: [1-9][\d,]* of [\d,]+ rows were there")
        with h5py.File(self.folder / "f.h5") as a, h5py.File(self.folder / "whole.h5") as b:
            for name in ["order", "counts", "of_a_hit", "starts", "nodes", "hits", "places"]:
                one, other = (f[f"form_factors/cut/{name}"][:] for f in (a, b))
                self.assertTrue(np.array_equal(one, other), name)
        self.assertFalse(os.path.exists(rows))

    def test_tables_between_surfaces_have_rows_that_sum_to_one(self):
        self.run_program("factors", SCENE, *CUT, "-o", "f.csv")
        lines = [line.split(",") for line in (self.folder / "f.csv").read_text().splitlines()
                 if not line.startswith("#")]
        names = [row[0] for row in lines[1:]]
        shares = [k for k, name in enumerate(lines[0]) if name in [*names, "backs", "sky"]]
        self.assertEqual(len(shares), len(names) + 2)
        for row in lines[1:]:
            values = [float(row[k]) for k in shares]
            self.assertGreaterEqual(min(values), 0)
            self.assertAlmostEqual(sum(values), 1, delta=1e-6)  # rounding

    def test_is_refused_where_pairs_are_needed(self):
        self.refuse("factors", SCENE, *CUT, "-o", "f.mtx", words=["--method exact"])

    def test_is_replaced_where_a_method_may_be_chosen_and_pairs_are_needed(self):
        self.run_program("factors", SCENE, *CUT, "-o", "cut.h5")
        run = self.run_program("factors", "cut.h5", "-o", "f.mtx", "--method", "auto",
                               "--tolerance", "0.1")
        self.assertRegex(run.out, r"form factors +recomputed: method cut -> auto")


if __name__ == "__main__":
    unittest.main()
