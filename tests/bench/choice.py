#!/usr/bin/env python3
"""Scores the choice that `--method auto` makes: choice.py PROGRAM FOLDER... [options]

Every scene file under the folders is meshed once; then form factors are computed by auto, by the
method that auto took and by the other one, on one thread, to every tolerance. Auto is right where
its processor time, the looks at both included, is within 1.3 of the faster one's. The other one may
take as long as auto has taken and is interrupted then: it was not faster.

  --limit S      seconds that a run may take; default 60. Where auto takes longer, there is no score
  --tolerance T  instead of 1e-2 and 1e-3; may be given more than once
  --match TEXT   only files whose path holds this
  --out DIR      where choice.csv and choice.md go; default out/bench. They grow scene by scene

Exit code 1 where a run failed for another reason than its time.
"""
import argparse
import json
import pathlib
import sys
import tempfile

from corpus import Finished
from scene_files import scene_files
from tables import write_table

WITHIN = 1.3
TOLERANCES = ("1e-2", "1e-3")
COLUMNS = {  # key: title
    "file": "file",
    "patches": "patches",
    "tolerance": "tolerance",
    "method": "auto took",
    "auto_s": "auto, s",
    "same_s": "the same, forced",
    "other_s": "the other one",
    "ratio": "auto over the faster",
    "right": "right",
}


class Case:
    """A meshed scene, in a folder of its own."""

    def __init__(self, program, folder, limit):
        self.program, self.folder, self.limit = program, folder, limit
        self.mesh = folder / "mesh.h5"
        self.failed = False

    def run(self, *arguments, limit):
        return Finished([self.program, *map(str, arguments), "--threads", "1"], self.folder, limit)

    def make_mesh(self, scene):
        run = self.run("mesh", scene, "-o", self.mesh, limit=self.limit)
        return run.code == 0

    def factors(self, method, tolerance, limit):
        """Processor seconds and the report; None if it took longer."""
        report = self.folder / f"{method}.json"
        run = self.run("factors", self.mesh, "-o", self.folder / "out.h5", "--method", method,
                       "--tolerance", tolerance, "--report", report, limit=limit)
        if run.late:
            return None, None
        if run.code != 0:
            self.failed = True
            print(run.err.strip(), file=sys.stderr)
            return None, None
        return run.processor_seconds, json.loads(report.read_text())

    def score(self, tolerance):
        auto, report = self.factors("auto", tolerance, self.limit)
        if auto is None:
            return {}
        method = report["form_factors"]["method"]
        same, _ = self.factors(method, tolerance, self.limit)
        # Seconds by the clock, of a machine that others may use, too: half as long again.
        patience = 1.5 * auto + 1
        other, _ = self.factors("rays" if method == "exact" else "exact", tolerance, patience)
        faster = min(s for s in (same, other, auto) if s is not None)
        return {"method": method, "auto_s": auto, "same_s": same, "other_s": other,
                "ratio": auto / faster, "right": auto <= WITHIN * faster,
                "patches": report["mesh"]["patches"]}


def text(key, value):
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.2f}"
    if value is None:
        return "-" if key == "other_s" else ""
    return f"{value:,}" if isinstance(value, int) else str(value)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--tolerance", action="append")
    parser.add_argument("--match", default="")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/bench"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows, failed = [], False
    for scene in scene_files(options.folders):
        if options.match not in str(scene):
            continue
        with tempfile.TemporaryDirectory(prefix="choice-") as folder:
            case = Case(options.program, pathlib.Path(folder), options.limit)
            if not case.make_mesh(scene):
                print(f"{scene.name}: not meshed")
                continue
            for tolerance in options.tolerance or TOLERANCES:
                row = {"file": f"{scene.parent.name}/{scene.name}", "tolerance": tolerance,
                       **case.score(tolerance)}
                rows.append(row)
                print(" ".join(f"{text(k, row.get(k)):>10}" for k in COLUMNS), flush=True)
            failed = failed or case.failed
        write_table(options.out, "choice", COLUMNS, rows, text)
    scored = [row for row in rows if "right" in row]
    right = sum(row["right"] for row in scored)
    print(f"\nauto was right in {right} of {len(scored)}; {len(rows) - len(scored)} took longer than "
          f"{options.limit:g} s; table in {options.out}/choice.md and .csv")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
