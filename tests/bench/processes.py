#!/usr/bin/env python3
"""Time of form factors and of a solution against the number of processes under mpirun, each on one
core: processes.py PROGRAM [options]

Strong scaling: the same patches for 1, 2, ... processes. Weak: as many pairs of patches a process.
Every run is repeated and the quickest counts; radiosities must be those of one process.

  --most P       processes, 1 and doubled up to this; default 2
  --patches N    of one process; default 4000
  --scene FILE   default data/cornell-box-closed.obj
  --repeat K     default 3
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def run(options, processes, patches, folder):
    """Seconds of the two stages, and the radiosities."""
    report, results = folder / "report.json", folder / "results.h5"
    results.unlink(missing_ok=True)
    subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes),
                    options.program, "solve", options.scene, "--patches", str(patches), "--method",
                    "exact", "--solver", "petsc", "--threads", "1", "--quiet", "-o", str(results),
                    "--report", str(report)], check=True, env=ENVIRONMENT)
    figures = json.loads(report.read_text())
    stages = {name: stage["seconds"] for name, stage in figures["stages"].items() if "seconds" in stage}
    with h5py.File(results) as file:
        return stages["form_factors"], stages["solution"], file["solution/radiosity"][()]


def best(options, processes, patches, folder):
    runs = [run(options, processes, patches, folder) for _ in range(options.repeat)]
    return min(r[0] for r in runs), min(r[1] for r in runs), runs[0][2]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--most", type=int, default=2)
    parser.add_argument("--patches", type=int, default=4000)
    parser.add_argument("--scene", default=str(ROOT / "data/cornell-box-closed.obj"))
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    counts = [2**k for k in range(options.most.bit_length())]
    print("scaling | processes | patches | form factors, s | efficiency | solution, s | efficiency")
    print("---|---|---|---|---|---|---")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        alone = best(options, 1, options.patches, folder)
        for kind in ("strong", "weak"):
            for processes in counts:
                more = 1 if kind == "strong" else math.sqrt(processes)
                found = best(options, processes, round(options.patches * more), folder)
                share = processes if kind == "strong" else 1
                if kind == "strong":
                    error = np.abs(found[2] - alone[2]).max() / np.abs(alone[2]).max()
                    if error > 1e-5:
                        sys.exit(f"{processes} processes: radiosities differ by {error:.1e}")
                print(f"{kind} | {processes} | {len(found[2])} | "
                      f"{found[0]:.2f} | {alone[0] / found[0] / share:.2f} | "
                      f"{found[1]:.2f} | {alone[1] / found[1] / share:.2f}", flush=True)


if __name__ == "__main__":
    main()
