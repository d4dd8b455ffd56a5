#!/usr/bin/env python3
"""Errors of test cases of CIE 171:2006, beside those of Blender's Cycles: cie_171.py PROGRAM [--only CASE]

Prints the table of src/illuminance/README.md. Exit code 1 if a case is off by .1% or more, or light falls where none
can.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
import cie_171  # noqa: E402

MOST = .1  # percent


class Runner:
    def __init__(self, program, folder):
        self.program, self.folder = pathlib.Path(program).resolve(), pathlib.Path(folder)

    def report(self, files, *arguments):
        for name, text in files.items():
            (self.folder / name).write_text(text)
        subprocess.run([self.program, "illuminance", "room.obj", *arguments, "--quiet", "--report", "r.json"],
                       cwd=self.folder, check=True, capture_output=True)
        return json.loads((self.folder / "r.json").read_text())

    def lux(self, case):
        (self.folder / "points.csv").write_text(
            "x,y,z,nx,ny,nz\n" + "".join(",".join(map(str, point)) + "\n" for point in case.points))
        self.report(case.files, "--points", "points.csv", "-o", "out.csv")
        return np.genfromtxt(self.folder / "out.csv", delimiter=",", names=True)["illuminance_lx"]


def error_of(run, case):
    """The largest of all points that light reaches, percent; none may reach the others (one of 5.7 is grazed: 1e-5 m
    above its place it gets .0001 lx)."""
    truth = np.array(case.truth)
    found = run.lux(case)
    if (found[truth == 0] > 1e-3).any():
        sys.exit(f"cie_171: {case.number}: light falls where none can: {found[truth == 0]}")
    return 100 * np.abs(found[truth > 0] / truth[truth > 0] - 1).max()


def error_between_walls(run):
    worst = 0
    for reflectance in cie_171.REFLECTANCES:
        files, arguments, truth = cie_171.between_walls(reflectance)
        mean = np.mean(cie_171.indirect_means(run.report(files, *arguments)))
        worst = max(worst, 100 * abs(mean / truth - 1))
    return worst


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--only", default="", help="cases whose number holds this")
    given = parser.parse_args()
    worst = 0
    print("| case | points | off by, at most | Cycles |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        run = Runner(given.program, folder)
        rows = [(case.number, case.what, len(case.points), case.cycles, lambda case=case: error_of(run, case))
                for case in cie_171.cases()]
        rows.append(("5.8", "light between walls, their mean, 11 reflectances", 4096, cie_171.CYCLES_BETWEEN_WALLS,
                     lambda: error_between_walls(run)))
        for number, what, points, cycles, measure in rows:
            if given.only not in number:
                continue
            error = measure()
            worst = max(worst, error)
            print(f"| {number}: {what} | {points} | {error:.2g}% | {cycles}% |", flush=True)
    return 1 if worst >= MOST else 0


if __name__ == "__main__":
    sys.exit(main())
