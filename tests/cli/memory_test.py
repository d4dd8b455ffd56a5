"""A run takes the memory that it forecast: within 20%, or 20 MiB for small runs."""

import json
import os
import subprocess
import sys
import unittest

from cli_runner import DATA, PROGRAM, CliTest

MIB = 2 ** 20
# Most of a small run is the program itself, parts of which may be in memory already.
LITTLE = 100 * MIB
ROUGH = 20 * MIB
SHARE = 0.2

RUNS = [
    ("cluttered.obj", "exact", "500", "--tolerance", "0.05"),
    ("cornell-box-closed.obj", "exact", "4000"),
    ("cornell-box-closed.obj", "exact", "2000", "--closure", "enforce", "--precision", "double"),
    ("cluttered.obj", "rays", "900", "--tolerance", "0.05"),
    ("cornell-box-closed.obj", "rays", "4000", "--tolerance", "0.1"),
    ("cluttered.obj", "hemicube", "900", "--resolution", "64"),
    ("cornell-box-closed.obj", "hemicube", "6000", "--resolution", "32"),
    ("blender-room.glb", "hemicube", "5000", "--resolution", "32", "--symmetrize"),
]


class MemoryTest(CliTest):
    def peak(self, scene, method, patches, *options):
        """Peak bytes of the run, and its forecast."""
        process = subprocess.Popen(
            [PROGRAM, "factors", str(DATA / scene), "--method", method, "--patches", patches,
             *options, "--threads", "2", "--quiet", "--report", "run.json", "-o", "f.h5"],
            cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0)
        os.remove(self.folder / "f.h5")
        report = json.loads((self.folder / "run.json").read_text())
        return usage.ru_maxrss * 1024, report["form_factors"]["estimated_bytes"]

    def test_peaks_match_the_forecast(self):
        for run in RUNS:
            with self.subTest(" ".join(run)):
                peak, foreseen = self.peak(*run)
                allowed = ROUGH if max(peak, foreseen) < LITTLE else SHARE * peak
                self.assertLessEqual(abs(peak - foreseen), allowed,
                                     f"{peak / MIB:.1f} MiB, foreseen {foreseen / MIB:.1f} MiB")


if __name__ == "__main__":
    sys.exit(unittest.main())
