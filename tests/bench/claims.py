#!/usr/bin/env python3
"""Measures figures that the READMEs state in their text again: claims.py PROGRAM [--only TEXT]

Each claim is a sentence, found by a pattern whose groups are its figures, and the commands that
measure them. The table gives both; exit code 1 if one is further off than the claim allows, or if a
sentence is not found. Figures of tables have benchmarks of their own (tests/bench/README.md).

  --only TEXT   only claims whose file or sentence holds this
  --list        print the claims and their commands, measure nothing
"""
import argparse
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DATA = ROOT / "data"


class Runner:
    """Runs the program in a folder of its own, on one thread."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)

    def report(self, *arguments):
        """The report of a run."""
        subprocess.run([self.program, *map(str, arguments), "--threads", "1", "--quiet", "--report", "r.json"],
                       cwd=self.folder, check=True, capture_output=True)
        return json.loads((self.folder / "r.json").read_text())

    def processor_seconds(self, *arguments):
        """What a run takes of a processor, in user mode."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.report(*arguments)
        return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def find(report, key):
    """The value of a key, wherever in the report it stands."""
    if isinstance(report, dict):
        if key in report:
            return report[key]
        report = list(report.values())
    for part in report if isinstance(report, list) else []:
        value = find(part, key)
        if value is not None:
            return value
    return None


def facing(run, *options):
    """F of the facing unit squares."""
    run.report("factors", DATA / "facing-plates.obj", "--faces-as-patches", *options, "--between", "surfaces",
               "-o", "facing.json")
    pairs = json.loads((run.folder / "facing.json").read_text())
    return pairs["form_factors"][0][1]


def one_eye(run):
    """Exact, and one hemicube a square."""
    exact = facing(run, "--method", "exact")
    seen = [facing(run, "--method", "hemicube", "--emitters", "estimated", "--resolution", size) for size in (64, 1024)]
    return [exact, seen[0], seen[1]]


def sweeps(run):
    """Of the closed Cornell box whose surfaces all reflect .99."""
    options = ["--solve-tolerance", "1e-6", "--max-iterations", "5000"]
    for name in ("white", "green", "red", "light"):
        options += ["--set", f"{name}.reflectance=.99"]
    run.report("factors", DATA / "cornell-box-closed.obj", "--patches", "1000", "-o", "box.h5")
    return [find(run.report("solve", "box.h5", *options, "--solver", solver), "iterations")
            for solver in ("jacobi", "gauss-seidel", "cg")]


def exact_beside_hemicubes(run):
    """Processor time of exact to 1e-3 over that of hemicubes, meshing not counted: in the cluttered
    and the curved scene, first without, then with exact rows and columns of emitters."""
    ratios = {"estimated": [], "exact": []}
    for scene, patches in (("cluttered", 1000), ("curved", 2000)):
        run.report("mesh", DATA / f"{scene}.obj", "--patches", patches, "-o", f"{scene}.h5")
        exact = run.processor_seconds("factors", f"{scene}.h5", "--method", "exact", "--tolerance", "1e-3")
        for emitters, of in ratios.items():
            of.append(exact / run.processor_seconds("factors", f"{scene}.h5", "--method", "hemicube",
                                                    "--resolution", "256", "--emitters", emitters))
    return ratios["estimated"] + ratios["exact"]


# file, sentence with its figures, what measures them, relative tolerance (and why)
CLAIMS = [
    ("src/formfactor/README.md",
     r"have F = ([\d.]+); one hemicube in\s+the middle sees ([\d.]+) with 64 pixels and ([\d.]+) with 1,024",
     one_eye, 2e-3),  # four digits are stated; a turn at random moves the last one
    ("src/solve/README.md",
     r"they take ([\d,]+) and ([\d,]+) sweeps to 1e-6,\s+where `cg` takes ([\d,]+) products",
     sweeps, 0.02),  # counts repeat; the patches may change a little
    ("src/formfactor/README.md",
     r"([\d.]+) and ([\d.]+) times as long as hemicubes of 256 pixels[^.]*;\s+([\d.]+) and ([\d.]+) times",
     exact_beside_hemicubes, 0.25),  # caches differ between machines
]


def stated_in(file, pattern):
    match = re.search(pattern, (ROOT / file).read_text())
    return [float(group.replace(",", "")) for group in match.groups()] if match else None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    wrong = 0
    for file, pattern, measure, tolerance in CLAIMS:
        if arguments.only not in file + pattern:
            continue
        print(f"{file}: {measure.__name__}: {(measure.__doc__ or '').strip()}")
        if arguments.list:
            continue
        stated = stated_in(file, pattern)
        with tempfile.TemporaryDirectory() as folder:
            measured = measure(Runner(arguments.program.resolve(), folder))
        held = stated is not None and all(
            abs(a - b) <= tolerance * abs(b) for a, b in zip(stated, measured, strict=True))
        print("  stated   ", "not found" if stated is None else stated)
        print("  measured ", [float(f"{value:.4g}") for value in measured], "" if held else "  <-- differs")
        wrong += not held
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
