#!/usr/bin/env python3
"""Time of form factors and of a solution against the number of processes under mpirun, each on one
core: processes.py PROGRAM [options]

Strong scaling: the same patches for 1, 2, ... processes. Weak: as many pairs of patches a process.
Every run is repeated, in turns. Seconds are medians; efficiency is the median of the ratios to one
process in the same turn. Radiosities must be those of one process.

  --most P       processes, 1 and doubled up to this; default 2
  --patches N    of one process; default 4000
  --scene FILE   default data/cornell-box-closed.obj
  --repeat K     default 3
"""
import argparse
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(options, processes, patches, folder):
    """Seconds of the two stages, and the radiosities."""
    report, table = folder / "report.json", folder / "radiosities.csv"
    subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes),
                    options.program, "solve", options.scene, "--patches", str(patches), "--method",
                    "exact", "--solver", "petsc", "--threads", "1", "--quiet", "-o", str(table),
                    "--report", str(report)], check=True, env=ENVIRONMENT)
    figures = json.loads(report.read_text())
    stages = {name: stage["seconds"] for name, stage in figures["stages"].items() if "seconds" in stage}
    with open(table) as lines:
        radiosities = [[float(row[f"radiosity_{band}"]) for band in (1, 2, 3)]
                       for row in csv.DictReader(lines)]
    return stages["form_factors"], stages["solution"], np.array(radiosities)


def measured(options, sizes, folder):
    """(processes, patches) -> the stages of its runs, turn by turn, and radiosities. The sizes take
    turns, since a machine that others use may be a third slower for minutes: sizes are compared
    within a turn."""
    turns, radiosities = {size: [] for size in sizes}, {}
    for _ in range(options.repeat):
        for size in sizes:
            *stages, radiosities[size] = run(options, *size, folder)
            turns[size].append(stages)
    return {size: (np.array(turns[size]), radiosities[size]) for size in sizes}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--most", type=int, default=2)
    parser.add_argument("--patches", type=int, default=4000)
    parser.add_argument("--scene", default=str(ROOT / "data/cornell-box-closed.obj"))
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    counts = [2**k for k in range(options.most.bit_length())]
    sizes = {"strong": [(p, options.patches) for p in counts],
             "weak": [(p, round(options.patches * math.sqrt(p))) for p in counts[1:]]}
    with tempfile.TemporaryDirectory() as name:
        found = measured(options, sizes["strong"] + sizes["weak"], pathlib.Path(name))
    alone, radiosities_alone = found[sizes["strong"][0]]
    print("scaling | processes | patches | form factors, s | efficiency | solution, s | efficiency")
    print("---|---|---|---|---|---|---")
    for kind in ("strong", "weak"):
        for size in sizes[kind]:
            turns, radiosities = found[size]
            share = size[0] if kind == "strong" else 1
            if kind == "strong":
                error = np.abs(radiosities - radiosities_alone).max() / radiosities_alone.max()
                if error > 1e-5:
                    sys.exit(f"{size[0]} processes: radiosities differ by {error:.1e}")
            seconds = np.median(turns, axis=0)
            efficiency = np.median(alone / turns / share, axis=0)
            print(f"{kind} | {size[0]} | {len(radiosities)} | {seconds[0]:.2f} | "
                  f"{efficiency[0]:.2f} | {seconds[1]:.2f} | {efficiency[1]:.2f}")


if __name__ == "__main__":
    main()
