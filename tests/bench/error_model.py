#!/usr/bin/env python3
"""Refits the fitted constants of the exact method, scores them, and writes error_model.h.

  error_model.py PROGRAM [--folder DIR] [--record]    refits and scores: a table
  error_model.py --write [NAME...]                    writes the header
  error_model.py --check                              is the header what --write would write?

PROGRAM is error_samples (cmake --preset release; ninja -C build/release error_samples), which
samples cells, parts, pairs and rows from inside the library and compares them with values that are
converged: cells cut into 64 to 256 parts, rows at a tolerance a tenth to a ten-thousandth of theirs,
formulas for pairs with nothing in between against contour integrals in long double. Constants are
refitted to TRAINING and scored on SCORING, scenes of data/ (pairs with nothing in between: two
random seeds), by the rules of error_model/fits.py. It takes some five minutes of processor time.

  --folder DIR   more scenes to score on: every scene file below; those that fail or take too long
                 are named and left out
  --record       writes the results to error_model/constants.csv, held values unchanged
  --write NAME   takes over the values of these constants that --record left there, to two digits

The table: constant, value held, value refitted to the training scenes, and the share of the
constant's cases whose error is below the stated one (root mean squares: kPairMargin times that),
with the value held in training and scoring scenes, and with the refitted one in the latter.
"""
import argparse
import concurrent.futures
import math
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER / "error_model"))
import constants  # noqa: E402

DATA = FOLDER.parents[1] / "data"
PAIRS = 800  # of a scene
SHAPES = 600  # pairs of each shape
LIMIT = 600  # seconds that one run of error_samples may take

# File, patches, and for rows the tolerance of the reference, and those scored; none if they take
# too long.
TRAINING = [
    ("cornell-box-closed.obj", 985, 1e-6, (1e-2, 1e-3, 1e-4)),
    ("two-rooms.obj", 500, 1e-6, (1e-2, 1e-3, 1e-4)),
    ("cluttered.obj", 300, 1e-3, (1e-1, 1e-2)),
    ("curved.obj", 300, 1e-3, (1e-1,)),
]
SCORING = [
    ("cornell-box-closed.obj", 600, 1e-6, (1e-2, 1e-3, 1e-4)),
    ("cornell-box.obj", 500, 1e-6, (1e-2, 1e-3, 1e-4)),
    ("blocked-plates.obj", 300, 1e-6, (1e-2, 1e-3, 1e-4)),
    ("furnished-room.obj", 300, None, ()),
]
OF_FOLDER = (500, 1e-3, (1e-1, 1e-2))
SEEDS = {"training": 1, "scoring": 1001}
SCENES = {".obj", ".gltf", ".glb", ".stl"}


def jobs(scenes, seed):
    """Words for error_samples."""
    yield ["shapes", str(SHAPES), str(seed)]
    for path, patches, reference, tolerances in scenes:
        yield ["scene", str(path), str(patches), str(PAIRS)]
        if tolerances:
            yield ["rows", str(path), str(patches), str(reference), *map(str, tolerances)]


def sample(program, words):
    """The output of error_samples, or nothing, and why."""
    try:
        done = subprocess.run([program, *words], capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return "", f"left out, after {LIMIT} s: {' '.join(words[:2])}"
    said = done.stderr.strip()
    if done.returncode != 0:
        return "", f"left out: {' '.join(words[:2])}: {said}"
    return done.stdout, ""


def sampled(program, scenes, seed):
    from samples import Samples

    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = list(pool.map(lambda words: sample(program, words), jobs(scenes, seed)))
    for _, why in found:
        if why:
            print(why, file=sys.stderr)
    return Samples(text for text, _ in found)


def held_values(record):
    held = {}
    for constant in constants.CONSTANTS:
        values = constants.numbers(record[constant.name]["value"])
        held[constant.name] = values if constant.type == "rules" else values[0]
    return held


def text_of(value):
    """To two digits; empty if nothing could be refitted."""
    if isinstance(value, list):
        return " ".join("kNever" if x == math.inf else text_of(x) or "-" for x in value)
    return "" if math.isnan(value) else f"{value:.2g}"


def refit(program, folder, record):
    import fits
    from cells import check_cells

    scenes = [[(DATA / s[0], *s[1:]) for s in part] for part in (TRAINING, SCORING)]
    if folder:
        scenes[1] += [(path, *OF_FOLDER) for path in sorted(folder.rglob("*"))
                      if path.suffix.lower() in SCENES]
    training = sampled(program, scenes[0], SEEDS["training"])
    scoring = sampled(program, scenes[1], SEEDS["scoring"])
    held = held_values(record)
    check_cells(training, held)
    fits.check_parts(training, held)
    for constant in constants.CONSTANTS:
        row = record[constant.name]
        row.update(refitted="", training="", scoring="", with_refitted="")
        if not constant.rule:
            continue
        value = fits.refitted(constant.name, training, held)
        row["refitted"] = text_of(value)
        shares = [fits.share_below(constant.name, training, held, held),
                  fits.share_below(constant.name, scoring, held, held)]
        if row["refitted"] and "-" not in row["refitted"].split():
            shares.append(fits.share_below(constant.name, scoring, held,
                                           held | {constant.name: value}))
        for column, share in zip(("training", "scoring", "with_refitted"), shares):
            row[column] = "" if math.isnan(share) else f"{100 * share:.1f}%"


def print_table(record):
    print("| constant | held | refitted | below, training | below, scoring | refitted, scoring |")
    print("|---|---|---|---|---|---|")
    for constant in constants.CONSTANTS:
        row = record[constant.name]
        if constant.rule:
            cells = [row[c] or "-" for c in ("value", "refitted", "training", "scoring",
                                             "with_refitted")]
            print(f"| {constant.name} | {' | '.join(cells)} |")
    by_hand = [c.name for c in constants.CONSTANTS if not c.rule]
    print(f"\nSet by hand: {', '.join(by_hand)}.")


def write(names, record):
    for name in names:
        if not record[name]["refitted"] or "-" in record[name]["refitted"].split():
            raise SystemExit(f"error_model: nothing was refitted for {name}")
        record[name]["value"] = record[name]["refitted"]
    constants.write_record(record)
    constants.HEADER.write_text(constants.header(record))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?")
    parser.add_argument("--folder", type=pathlib.Path)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--write", nargs="*", metavar="NAME",
                        choices=[c.name for c in constants.CONSTANTS])
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    record = constants.read_record()
    if options.check:
        if constants.HEADER.read_text() != constants.header(record):
            raise SystemExit(f"error_model: {constants.HEADER} is not what --write would write")
    elif options.write is not None:
        write(options.write, record)
    elif options.program:
        refit(options.program, options.folder, record)
        print_table(record)
        if options.record:
            constants.write_record(record)
    else:
        parser.error("give PROGRAM, --write or --check")


if __name__ == "__main__":
    main()
