#!/usr/bin/env python3
"""The examples of CONTRIBUTING.md, "What a new thing costs": each is a patch in this folder that adds a
toy of its kind. The test applies them and counts the files that each changes beside its own; with
--build they are built together and tried, which takes a while.

    additions_test.py                   each applies, and changes as many files as the table says
    additions_test.py --build FOLDER    a copy of the tree with all of them, built there and tried
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]

# The patch, and how the table names what it adds.
ADDITIONS = {
    "option": "an option, a figure of a report",
    "figure": "an option, a figure of a report",
    "stage": "a stage",
    "method": "a form-factor method",
    "format": "a scene format",
    "light": "a kind of light without a surface",
}
# What is run once all are built, and what it prints. {} is the folder of the copy.
TRIALS = [
    ("option", ["help", "gather"], r"--dim FACTOR +What is gathered counts times this"),
    ("option", ["gather", "data/cornell-box.obj", "--dim", "2"], r"--dim.*out of range; 0 to 1"),
    ("option", ["gather", "data/cornell-box.obj", "--patches", "60", "--passes", "2", "--dim", "0",
                "-o", "dim.h5"], r"gather"),
    ("option", ["gather", "dim.h5", "--dim", "1"], r"recomputed: dim 0 -> "),
    ("figure", ["factors", "data/cornell-box.obj", "--patches", "60", "--method", "rays"],
     r"rows that see the sky +[1-9]"),
    ("light", ["solve", "data/cornell-box.obj", "--patches", "60", "--beam", "1,elevation=0", "-o",
                "beam.h5"],
     r"from the sky and lamps +[0-9.]*[1-9]"),
    ("light", ["info", "beam.h5"], r"beam=1,elevation=0"),
    ("format", ["info", "one.tri"], r"(?i)1 face"),
    ("method", ["solve", "data/cornell-box.obj", "--patches", "60", "--method", "touching"],
     r"touching"),
    ("stage", ["--gtest_filter=SurfaceMeansStage.*"], r"PASSED +. 1 test"),
]


def files_of(patch):
    """Those that the patch changes, and those that it adds."""
    parts = re.split(r"(?m)^diff --git a/", patch.read_text())[1:]
    name = {True: [], False: []}
    for part in parts:
        name["new file mode" in part.split("@@")[0]].append(part.split(" ")[0])
    return name[False], name[True]


def apply(patch, tree):
    """The complaint, if it does not apply."""
    done = subprocess.run(["git", "apply", HERE / f"{patch}.patch"], cwd=tree, capture_output=True,
                          text=True, env={**os.environ, "GIT_CEILING_DIRECTORIES": str(tree.parent)})
    return done.stderr


class AdditionsTest(unittest.TestCase):
    def test_each_changes_as_many_files_as_the_table_says(self):
        table = (ROOT / "CONTRIBUTING.md").read_text()
        costs = dict(re.findall(r"(?m)^\| (an? [^|]+?) \| (\d+) \|", table))
        for name, what in ADDITIONS.items():
            with self.subTest(name):
                changed, _ = files_of(HERE / f"{name}.patch")
                self.assertEqual(len(changed), int(costs[what]), changed)

    def test_all_apply_together(self):
        with tempfile.TemporaryDirectory() as folder:
            tree = pathlib.Path(folder)
            for name in ADDITIONS:
                for file in files_of(HERE / f"{name}.patch")[0]:
                    (tree / file).parent.mkdir(parents=True, exist_ok=True)
                    if not (tree / file).exists():
                        shutil.copy(ROOT / file, tree / file)
                self.assertEqual(apply(name, tree), "", f"bring {name}.patch up to date")

    def test_each_patch_is_listed(self):
        self.assertEqual({p.stem for p in HERE.glob("*.patch")}, set(ADDITIONS))


def build(tree):
    """Builds a copy of what is checked out with all patches, and tries each. The number of
    failures."""
    shutil.rmtree(tree, ignore_errors=True)
    tree.mkdir(parents=True)
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True, text=True)
    for file in files.stdout.splitlines():
        (tree / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, tree / file)
    for name in ADDITIONS:
        if complaint := apply(name, tree):
            sys.exit(f"additions: {complaint}")
    for command in (["cmake", "--preset", "release", "-DRADIOSITY_TESTS=ON"],
                    ["cmake", "--build", "--preset", "release", "--parallel", "2", "--target",
                     "radiosity_cli", "pipeline_tests"]):
        subprocess.run(command, cwd=tree, check=True)
    return try_all(tree)


def try_all(tree):
    (tree / "one.tri").write_text("0 0 0  1 0 0  0 1 0\n")
    failures = 0
    for name, words, expected in TRIALS:
        command = [tree / "build/release/radiosity", *words]
        if name == "stage":
            command = [tree / "build/release/tests/pipeline_tests", *words]
        done = subprocess.run(command, cwd=tree, capture_output=True, text=True)
        said = done.stdout + done.stderr
        held = re.search(expected, said) is not None
        failures += not held
        print(f"{name}: {'holds' if held else 'FAILS'}: {' '.join(words)}")
        if not held:
            print(said)
    print(f"additions: {len(TRIALS)} trials, {failures} failed")
    return failures


if __name__ == "__main__":
    if sys.argv[1:2] == ["--build"]:
        sys.exit(1 if build(pathlib.Path(sys.argv[2]).resolve()) else 0)
    unittest.main()
