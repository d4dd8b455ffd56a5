#!/usr/bin/env python3
"""error_model.h is what tests/bench/error_model.py writes: nobody edited it by hand."""
import os
import pathlib
import subprocess
import sys
import unittest

BENCH = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"]) / "tests/bench"
sys.path.insert(0, str(BENCH / "error_model"))
import constants  # noqa: E402


class ErrorModel(unittest.TestCase):
    def test_header_is_as_written(self):
        done = subprocess.run([sys.executable, BENCH / "error_model.py", "--check"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_edit_would_be_noticed(self):
        record = constants.read_record()
        for constant in constants.CONSTANTS:
            other = dict(record[constant.name], value="123")
            self.assertNotEqual(constants.header(record | {constant.name: other}),
                                constants.HEADER.read_text(), constant.name)

    def test_every_constant_is_refitted_or_says_why_not(self):
        record = constants.read_record()
        self.assertEqual(sorted(record), sorted(c.name for c in constants.CONSTANTS))
        for constant in constants.CONSTANTS:
            self.assertNotEqual(bool(constant.rule), bool(constant.reason), constant.name)


if __name__ == "__main__":
    unittest.main()
