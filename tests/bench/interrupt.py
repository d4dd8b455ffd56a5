#!/usr/bin/env python3
"""Interrupts the program at random moments: interrupt.py PROGRAM FOLDER [options]

Each scene file under a folder is run several times (`radiosity factors FILE -o x.h5`, or another
subcommand) and gets a SIGINT after a time drawn at random, evenly in its logarithm, so that short
stages are met as well as long ones. Every answer that took longer than half a second is reported
with its time and the program's stage. Only files that were there before may be left.

  --each N       runs a file; default 5
  --most S       the latest interruption; default 60
  --seed N       of the moments
  --match TEXT   only files whose path holds this
  --command TEXT factors (the default), mesh, solve or render

Exit code 1 where an answer took too long, was not exit code 1 with one line, or left something.
"""
import argparse
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

from corpus import scene_files

ENOUGH = 0.5  # seconds
LEAST = 0.02
GIVE_UP = 60
OUTPUT = {"factors": "x.h5", "mesh": "x.h5", "solve": "x.h5", "render": "x.png"}


def stage_of(err, out):
    """The last stage reported at work, or else the last one reported done."""
    stages = re.findall(r"^([a-z ]+): (?:\d+%|done)", err, re.M)
    words = [line for line in out.splitlines() if line.strip()]
    return stages[-1] if stages else (words[-1][:60] if words else "reading")


def interrupt(program, command, scene, moment):
    """Seconds to the answer (None: the run was over before), stage, and its fault."""
    with tempfile.TemporaryDirectory(prefix="interrupt-") as folder:
        process = subprocess.Popen(
            [program, command, str(scene), "-o", f"{folder}/{OUTPUT[command]}"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        try:
            process.wait(moment)
            process.communicate()
            return None, "", ""
        except subprocess.TimeoutExpired:
            pass
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        wrong = ""
        try:
            out, err = process.communicate(timeout=GIVE_UP)
        except subprocess.TimeoutExpired:
            process.kill()
            out, err = process.communicate()
            wrong = "had to be killed"
        seconds = time.monotonic() - start
        left = [p.name for p in pathlib.Path(folder).iterdir()]
        if process.returncode == 0:
            return None, "", ""  # it was done before the signal came
        if process.returncode == -signal.SIGINT:
            return seconds, "starting", "left " + ", ".join(left) if left else ""  # before main()
        if not wrong and process.returncode != 1:
            wrong = f"exit code {process.returncode}"
        elif not wrong and not err.rstrip().endswith("interrupted; nothing was written"):
            wrong = "last line: " + err.strip().splitlines()[-1]
        elif left:
            wrong = "left " + ", ".join(left)
        return seconds, stage_of(err, out), wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--each", type=int, default=5)
    parser.add_argument("--most", type=float, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--match", default="")
    parser.add_argument("--command", choices=sorted(OUTPUT), default="factors")
    options = parser.parse_args()
    draw = random.Random(options.seed)
    answers = []
    bad = 0
    for scene in scene_files(options.folder, options.match):
        latest = options.most
        for _ in range(options.each):
            moment = LEAST * (latest / LEAST) ** draw.random()
            seconds, stage, wrong = interrupt(options.program, options.command, scene, moment)
            if seconds is None:
                latest = max(2 * LEAST, min(latest, moment))
                continue
            answers.append(seconds)
            if seconds > ENOUGH or wrong:
                bad += 1
                print(f"{scene.relative_to(options.folder)}: {seconds:.2f} s, interrupted after "
                      f"{moment:.2f} s in: {stage}{'; ' + wrong if wrong else ''}", flush=True)
    if answers:
        answers.sort()
        print(f"{len(answers)} answers: median {answers[len(answers) // 2]:.2f} s, longest "
              f"{answers[-1]:.2f} s; {sum(a > ENOUGH for a in answers)} over {ENOUGH} s")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
