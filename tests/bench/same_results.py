#!/usr/bin/env python3
"""Shows that a change of the code changes no result, or by how much.

  same_results.py keep PROGRAM INTO SCENE...   runs every scene file given, or under a folder
  same_results.py compare BEFORE AFTER          holds two kept folders against each other

Each scene is rendered as it comes, with a sky so that there is light. Those under --small folders
are also run by the other ways through the program: exact with closure enforced, hemicubes merged,
and gathering. Kept are results file, picture and report of each. Compared are all values of the
results files but times, and the pictures, to the bit; differences are given relative to the largest
value; and seconds of the run, as a ratio.

  --limit S      seconds a run may take; default 300
  --small DIR    a folder of small scenes; may be repeated

Exit code 1 where something differs.
"""
import argparse
import pathlib
import subprocess
import sys
import time

import h5py
import numpy as np

from scene_files import scene_files

DEFAULT = {"as-it-comes": ["render", "--sky", "1"]}
OTHERS = {
    "enforced": ["render", "--sky", "1", "--patches", "300", "--method", "exact", "--closure",
                 "enforce"],
    "hemicubes": ["render", "--sky", "1", "--patches", "500", "--method", "hemicube",
                  "--symmetrize"],
    "gathered": ["gather", "--patches", "300", "--passes", "3"],
}
TIMED = ("seconds", "estimated", "measured", "bytes")  # in names of fields: the machine's, not ours


def run(program, scene, words, into, limit):
    """One way through the program; `seconds` holds how long it took, `said` what it said."""
    into.mkdir(parents=True, exist_ok=True)
    command = [program, words[0], str(scene), *words[1:], "-o", str(into / "results.h5"),
               "-o", str(into / "picture.png"), "--report", str(into / "report.json")]
    start = time.monotonic()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
        said = done.stderr if done.returncode != 0 else ""
    except subprocess.TimeoutExpired:
        said = "too long"
    seconds = time.monotonic() - start
    (into / "seconds").write_text(f"{seconds:.3f}\n")
    (into / "said").write_text(said)
    return seconds, said


def keep(options):
    for scene in scene_files(options.scene + options.small):
        small = any(scene.is_relative_to(folder) for folder in options.small)
        for name, words in {**DEFAULT, **(OTHERS if small else {})}.items():
            into = options.into / f"{scene.parent.name}-{scene.name}-{name}"
            seconds, said = run(options.program, scene, words, into, options.limit)
            print(f"{seconds:8.1f} s  {into.name}  {said.strip().splitlines()[-1:] or ''}", flush=True)


def fields(path):
    """Values of a results file by name."""
    values = {}

    def visit(name, node):
        if isinstance(node, h5py.Dataset) and not name.rpartition("/")[2].startswith(TIMED):
            values[name] = node[()]
        for key, value in node.attrs.items():
            if not any(word in key for word in TIMED):
                values[f"{name}:{key}"] = value

    with h5py.File(path) as file:
        file.visititems(visit)
    return values


def off_by(before, after):
    """None where two values are the same; else how far they are apart."""
    before, after = np.asarray(before), np.asarray(after)
    if before.shape != after.shape or before.dtype != after.dtype:
        return f"shape {before.shape} {after.shape}"
    if before.tobytes() == after.tobytes():
        return None
    if before.dtype.kind not in "fiu":
        return None if (before == after).all() else "other words"
    largest = np.abs(before.astype(float)).max()
    return f"{np.abs(after.astype(float) - before.astype(float)).max() / (largest or 1):.1e}"


def differences(before, after):
    if (before / "said").read_text() != (after / "said").read_text():
        yield "said", "other words"
    for name in ("picture.png", "results.h5"):
        present = [(folder / name).exists() for folder in (before, after)]
        if present[0] != present[1]:
            yield name, "missing"
    if (before / "picture.png").exists() and (after / "picture.png").exists():
        if (before / "picture.png").read_bytes() != (after / "picture.png").read_bytes():
            yield "picture.png", "other bytes"
    if not ((before / "results.h5").exists() and (after / "results.h5").exists()):
        return
    old, new = fields(before / "results.h5"), fields(after / "results.h5")
    for field in sorted(old.keys() | new.keys()):
        if field not in old or field not in new:
            yield field, "missing"
        elif off := off_by(old[field], new[field]):
            yield field, off


def compare(options):
    changed = 0
    ratios = []
    for before in sorted(p for p in options.before.iterdir() if p.is_dir()):
        after = options.after / before.name
        if not (after / "said").exists():
            print(f"{before.name}: not kept after")
            changed += 1
            continue
        if "too long" in [(f / "said").read_text() for f in (before, after)]:
            print(f"{before.name}: too long to tell")
            continue
        found = list(differences(before, after))
        seconds = [float((f / "seconds").read_text()) for f in (before, after)]
        ratios.append(seconds[1] / seconds[0])
        changed += 1 if found else 0
        what = "; ".join(f"{name} {off}" for name, off in found[:6])
        more = f"; and {len(found) - 6} more" if len(found) > 6 else ""
        print(f"{before.name}: {what + more or 'the same'}  (time {ratios[-1]:.2f})")
    print(f"{changed} of {len(ratios)} differ; median ratio of times {np.median(ratios):.2f}")
    return 1 if changed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    keeping = verbs.add_parser("keep")
    keeping.add_argument("program")
    keeping.add_argument("into", type=pathlib.Path)
    keeping.add_argument("scene", type=pathlib.Path, nargs="*")
    keeping.add_argument("--small", type=pathlib.Path, action="append", default=[])
    keeping.add_argument("--limit", type=float, default=300)
    comparing = verbs.add_parser("compare")
    comparing.add_argument("before", type=pathlib.Path)
    comparing.add_argument("after", type=pathlib.Path)
    options = parser.parse_args()
    return compare(options) if options.verb == "compare" else keep(options)


if __name__ == "__main__":
    sys.exit(main())
