#!/usr/bin/env python3
"""error_model.h is the output of tests/bench/error_model.py, not edited by hand. The script's
formulas match the library's."""
import os
import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"])
BENCH = ROOT / "tests/bench"
SAMPLER = pathlib.Path(os.environ["RADIOSITY_BUILD_DIR"]) / "tests/bench/error_samples/error_samples"
sys.path[:0] = [str(BENCH), str(BENCH / "error_model")]
import cells  # noqa: E402
import constants  # noqa: E402
import error_model  # noqa: E402
import fits  # noqa: E402
from samples import Samples  # noqa: E402


class ErrorModel(unittest.TestCase):
    def test_the_header_equals_the_output_of_the_script(self):
        done = subprocess.run([sys.executable, BENCH / "error_model.py", "--check"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_edited_value_changes_the_header(self):
        record = constants.read_record()
        for constant in constants.CONSTANTS:
            other = dict(record[constant.name], value="123")
            self.assertNotEqual(constants.header(record | {constant.name: other}),
                                constants.HEADER.read_text(), constant.name)

    def test_every_constant_has_a_rule_or_a_reason(self):
        record = constants.read_record()
        self.assertEqual(sorted(record), sorted(c.name for c in constants.CONSTANTS))
        for constant in constants.CONSTANTS:
            self.assertNotEqual(bool(constant.rule), bool(constant.reason), constant.name)

    def test_formulas_of_cells_and_parts_match_the_library(self):
        jobs = (["shapes", "2", "1"],
                ["scene", ROOT / "data/two-rooms.obj", "60", "60"],
                ["rows", ROOT / "data/blocked-plates.obj", "40", "1e-5", "1e-3"])
        found = [error_model.sample(SAMPLER, list(map(str, words))) for words in jobs]
        self.assertEqual([why for _, why in found], [""] * len(jobs))
        samples = Samples(text for text, _ in found)
        for kind in (*Samples.NAMES, "cell4", "cell9"):
            table = vars(getattr(samples, kind))
            self.assertGreater(len(table["run"]), 0, kind)
        held = error_model.held_values(constants.read_record())
        cells.check_cells(samples, held)
        fits.check_parts(samples, held)
        for name in ("kCellKinked9", "kCellBorder4"):
            with self.assertRaises(SystemExit):
                cells.check_cells(samples, held | {name: 2 * held[name]})
        with self.assertRaises(SystemExit):
            fits.check_parts(samples, held | {"kPartFactor": 2 * held["kPartFactor"]})


if __name__ == "__main__":
    unittest.main()
