"""Runs the built program (environment variable RADIOSITY) for the command-line tests."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import h5py

PROGRAM = os.environ["RADIOSITY"]
DATA = Path(os.environ["RADIOSITY_SOURCE_DIR"]) / "data"
# Built with node and npm: `view` can write pages.
HAS_PAGES = os.environ["RADIOSITY_PAGES"] == "1"

# How many times longer a run may take than that of a release build: under a sanitizer.
PATIENCE = int(os.environ.get("RADIOSITY_PATIENCE", "1"))


def limit(seconds):
    """What a run that takes `seconds` of a release build at most may take of this one."""
    return PATIENCE * seconds


# Small enough for a run to take a fraction of a second.
# Hemicubes as they see: the same as gathering at patches, whatever emits.
SMALL = ["--patches", "60", "--method", "hemicube", "--resolution", "32", "--emitters", "estimated"]

BOX_MTL = """newmtl lamp
Kd 0.2 0.2 0.2
Ke 5 4 3
newmtl wall
Kd 0.5 0.6 0.7
"""

# A closed unit cube seen from inside: five walls and a ceiling that shines.
BOX_OBJ = """mtllib box.mtl
v 0 0 0
v 0 0 1
v 1 0 1
v 1 0 0
v 0 1 0
v 1 1 0
v 1 1 1
v 0 1 1
o room
usemtl wall
f 1 2 3 4
f 1 4 6 5
f 2 8 7 3
f 1 5 8 2
f 4 3 7 6
o ceiling
usemtl lamp
f 5 6 7 8
"""


class Run:
    def __init__(self, process):
        self.code = process.returncode
        self.out = process.stdout
        self.err = process.stderr


def arrays_of(group):
    """The names of all arrays of a group of a results file, besides its report."""
    names = []
    group.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    return [name for name in names if not name.startswith("report/")]


class CliTest(unittest.TestCase):
    """A folder of its own with box.obj in it, and a way to run the program there."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.write("box.obj", BOX_OBJ)
        self.write("box.mtl", BOX_MTL)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def files(self):
        """All names in the folder, hidden ones too: a temporary file left behind shows here."""
        return sorted(p.name for p in self.folder.iterdir())

    def run_program(self, *arguments, code=0):
        process = subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=self.folder, capture_output=True, text=True, timeout=limit(300), check=False)
        self.assertEqual(
            process.returncode, code,
            f"radiosity {' '.join(map(str, arguments))}\n{process.stdout}\n{process.stderr}")
        return Run(process)

    def report(self, *arguments, code=0):
        """Runs with --report and returns its contents."""
        self.run_program(*arguments, "--report", "run.json", code=code)
        return json.loads((self.folder / "run.json").read_text())

    def refuse(self, *arguments, code=2, words=()):
        """The run must fail with one line on standard error that has all `words` in it, and leave
        the folder as it was."""
        before = self.files()
        run = self.run_program(*arguments, code=code)
        lines = run.err.splitlines()
        self.assertEqual(len(lines), 1, run.err)
        self.assertTrue(lines[0].startswith("radiosity: "), run.err)
        for word in words:
            self.assertIn(word, lines[0])
        self.assertEqual(self.files(), before)
        return lines[0]

    def assert_same_factors(self, first, second):
        """All arrays of the form factors of two results files, to the bit."""
        with h5py.File(self.folder / first) as a, h5py.File(self.folder / second) as b:
            a, b = a["form_factors"], b["form_factors"]
            arrays = arrays_of(a)
            self.assertTrue({"data", "cut/hits"} & set(arrays))
            self.assertEqual(arrays, arrays_of(b))
            for name in arrays:
                self.assertEqual(a[name][()].tobytes(), b[name][()].tobytes(), name)
