#!/usr/bin/env python3
"""Runs the program on every scene file under a folder: corpus.py PROGRAM FOLDER [options]

Each file gets `radiosity factors FILE -o x.h5 --report r.json` and nothing else, like a person's
first try on a file of their own. A table gives the result: outcome, sizes, method, times and
memory beside the forecast, the error figure, and the last line of each failure. The results file is
read back: nothing in it may be NaN or infinite.

  --limit S     seconds a file may take; default 300. It is interrupted then, and killed ten later
  --out DIR     where corpus.csv and corpus.md go; default out/bench. They grow file by file
  --match TEXT  only files whose path holds this
  --            arguments after it go to the program, too

Exit code 1 if a file was not finished in time, failed, or holds a non-finite number.
"""
import argparse
import json
import math
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time

from scene_files import SCENES, scene_files
from tables import write_table

MEBIBYTE = 1024.0 * 1024.0
GRACE = 10  # seconds between an interruption and the end
POLL = 0.02

COLUMNS = {  # key: title
    "file": "file",
    "outcome": "outcome",
    "faces": "faces",
    "patches": "patches",
    "method": "method",
    "mesh_s": "mesh s",
    "plan_s": "plan s",
    "foreseen_s": "factors s, foreseen",
    "true_s": "true",
    "all_s": "all s",
    "foreseen_mib": "MiB, foreseen",
    "peak_mib": "true",
    "error_figure": "error of F",
    "error_median": "row error, median",
    "error_largest": "largest",
    "said": "last words",
}


class Finished:
    """A run that ended: exit code (negative: signal), seconds by the clock and of the processor, peak
    memory, and what was printed."""

    def __init__(self, command, folder, limit):
        out, err = folder / "out", folder / "err"
        start = time.monotonic()
        self.late = False
        with open(out, "wb") as o, open(err, "wb") as e:
            child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=o, stderr=e)
            try:
                usage = self.wait(child, start, limit)
            except KeyboardInterrupt:
                child.kill()
                raise
        self.seconds = time.monotonic() - start
        self.peak_bytes = usage.ru_maxrss * 1024
        self.processor_seconds = usage.ru_utime + usage.ru_stime
        self.out = out.read_text(errors="replace")
        self.err = err.read_text(errors="replace")

    def wait(self, child, start, limit):
        while True:
            pid, status, usage = os.wait4(child.pid, os.WNOHANG)
            if pid != 0:
                child.returncode = self.code = os.waitstatus_to_exitcode(status)
                return usage
            seconds = time.monotonic() - start
            if seconds > limit and not self.late:
                self.late = True
                child.send_signal(signal.SIGINT)
            if seconds > limit + GRACE:
                child.kill()
            time.sleep(POLL)


def not_finite(path):
    """Fields of the results file with non-finite numbers. In a process of its own: this one's memory
    when it starts the program would count as the program's."""
    script = pathlib.Path(__file__).with_name("not_finite.py")
    return subprocess.run([sys.executable, script, path], check=True, capture_output=True,
                          text=True).stdout.strip()


def outcome(run, limit):
    if run.late:
        return f"over {limit:g} s" + (", killed" if run.code == -signal.SIGKILL else "")
    if run.code < 0:
        return f"crashed ({signal.Signals(-run.code).name})"
    return "done" if run.code == 0 else f"failed ({run.code})"


def last_words(run):
    """The one-line error; after the time limit, the last stage."""
    lines = [line for line in run.err.splitlines() if line.strip()]
    if run.late:
        lines = [line for line in lines if not line.startswith("radiosity:")]
        lines = lines or [line for line in run.out.splitlines() if line.strip()]
    return lines[-1].strip() if lines else ""


def measured(report):
    """The figures of a report, as far as it got."""
    factors = report.get("form_factors", {})
    mesh = report.get("mesh", {})
    row = {
        "faces": report.get("scene", {}).get("faces"),
        "patches": mesh.get("patches"),
        "method": factors.get("method"),
        "mesh_s": report.get("stages", {}).get("mesh", {}).get("seconds"),
        "plan_s": factors.get("seconds_plan"),
        "foreseen_s": factors.get("estimated_seconds"),
        "true_s": factors.get("seconds", 0) - factors.get("seconds_plan", 0) if factors else None,
        "error_figure": factors.get("error_figure"),
        "error_median": factors.get("row_error_median"),
        "error_largest": factors.get("row_error_largest"),
    }
    if "estimated_bytes" in factors:
        row["foreseen_mib"] = factors["estimated_bytes"] / MEBIBYTE
    return row


def run_file(program, scene, name, limit, extra):
    with tempfile.TemporaryDirectory(prefix="corpus-") as folder:
        folder = pathlib.Path(folder)
        results, report = folder / "x.h5", folder / "r.json"
        run = Finished([program, "factors", str(scene), "-o", str(results), "--report",
                        str(report), *extra], folder, limit)
        row = {key: None for key in COLUMNS}
        row.update(file=name, outcome=outcome(run, limit), all_s=run.seconds,
                   peak_mib=run.peak_bytes / MEBIBYTE, said="")
        if report.exists():
            row.update(measured(json.loads(report.read_text())))
        if row["outcome"] != "done":
            row["said"] = last_words(run).replace(str(scene), scene.name)
        elif not results.exists():
            row.update(outcome="no results", said="exit code 0, and no results file")
        elif bad := not_finite(results):
            row.update(outcome="not finite", said="not finite: " + bad)
    return row


def text(key, value):
    if value is None:
        return ""
    if isinstance(value, float):
        if key.startswith("error"):
            return f"{value:.1e}"
        return f"{value:.0f}" if value >= 100 else f"{value:.1f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def print_row(values, width):
    numeric = list(COLUMNS)[2:-1]
    cells = [f"{v:>9}" if key in numeric else f"{v:<{width if key == 'file' else 12}}"
             for key, v in values.items()]
    print(" ".join(cells).rstrip(), flush=True)


def print_ratios(rows, foreseen, true, what):
    """How far the forecast is from the need."""
    ratios = [row[foreseen] / row[true] for row in rows
              if row[foreseen] and row[true] and row["outcome"] == "done"]
    if not ratios:
        return
    within = sum(0.5 <= r <= 2 for r in ratios)
    print(f"{what}: foreseen / true from {min(ratios):.2g} to {max(ratios):.2g}, median "
          f"{statistics.median(ratios):.2g}; {within} of {len(ratios)} within a factor of 2")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=300)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/bench"))
    parser.add_argument("--match", default="")
    arguments = sys.argv[1:]
    extra = []
    if "--" in arguments:
        extra = arguments[arguments.index("--") + 1:]
        arguments = arguments[:arguments.index("--")]
    options = parser.parse_args(arguments)
    if not (math.isfinite(options.limit) and options.limit > 0):
        parser.error(f"--limit {options.limit}: give seconds above 0")
    files = [f for f in scene_files([options.folder]) if options.match in str(f)]
    if not files:
        parser.error(f"{options.folder}: no scene files ({' '.join(sorted(SCENES))}) under it")
    options.out.mkdir(parents=True, exist_ok=True)
    names = [str(f.relative_to(options.folder)) for f in files]
    width = max(map(len, names))
    print_row({**{key: title.split(",")[-1].strip() for key, title in COLUMNS.items()},
               "mesh_s": "mesh s", "plan_s": "plan s", "all_s": "all s",
               "error_figure": "of F", "error_median": "of rows"}, width)
    rows = []
    for scene, name in zip(files, names):
        rows.append(run_file(options.program, scene, name, options.limit, extra))
        print_row({key: text(key, rows[-1][key]) for key in COLUMNS}, width)
        write_table(options.out, "corpus", COLUMNS, rows, text)
    done = sum(row["outcome"] == "done" for row in rows)
    print(f"\n{done} of {len(rows)} files done; table in {options.out}/corpus.md and .csv")
    print_ratios(rows, "foreseen_s", "true_s", "time of form factors")
    print_ratios(rows, "foreseen_mib", "peak_mib", "memory")
    return 0 if done == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
