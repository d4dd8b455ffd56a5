#!/usr/bin/env python3
"""The account of what was tried and held: held.csv, and the table that README.md shows of it.

    tests/held.py add WHAT COUNT UNIT FAULTS [NOTE]   a line of today, of the commit checked out; the
                                                      note is a few words, as the table shows it
    tests/held.py table                               makes the table in README.md anew
"""
import csv
import datetime
import pathlib
import subprocess
import sys

FOLDER = pathlib.Path(__file__).resolve().parent
LINES = FOLDER / "held.csv"
README = FOLDER / "README.md"
BEGIN, END = "<!-- held: made by tests/held.py -->", "<!-- held: end -->"
LONGEST_NOTE = 40  # so that a line of the table fits README.md
COLUMNS = ["date", "commit", "what", "count", "unit", "faults", "note"]


def lines():
    with LINES.open(newline="") as file:
        return list(csv.DictReader(file))


def add(what, count, unit, faults, note=""):
    if len(note) > LONGEST_NOTE:
        sys.exit(f"held.py: the note has {len(note)} characters; at most {LONGEST_NOTE} fit the table")
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=FOLDER, check=True,
                            capture_output=True, text=True).stdout.strip()
    today = datetime.datetime.now(datetime.timezone.utc).date().isoformat()
    with LINES.open("a", newline="") as file:
        csv.writer(file, lineterminator="\n").writerow(
            [today, commit, what, int(count), unit, int(faults), note])


def table():
    """The last run of each kind, and what all its runs come to since the first one without a
    fault."""
    runs = {}
    for line in lines():
        runs.setdefault(line["what"], []).append(line)
    rows = ["| what | last run | commit | tried | found | clean since | tried since |",
            "|---|---|---|---|---|---|---|"]
    for what, of_it in sorted(runs.items()):
        last = of_it[-1]
        clean = []
        for line in reversed(of_it):
            if int(line["faults"]):
                break
            clean.append(line)
        found = last["note"] or (last["faults"] if int(last["faults"]) else "nothing")
        rows.append("| {} | {} | {} | {:,} {} | {} | {} | {} |".format(
            what, last["date"], last["commit"], int(last["count"]), last["unit"], found,
            clean[-1]["date"] if clean else "-",
            "{:,} {}".format(sum(int(c["count"]) for c in clean), last["unit"]) if clean else "-"))
    text = README.read_text()
    head, _, rest = text.partition(BEGIN)
    _, _, tail = rest.partition(END)
    README.write_text(head + BEGIN + "\n" + "\n".join(rows) + "\n" + END + tail)


def main(words):
    if len(words) in (5, 6) and words[0] == "add":
        add(*words[1:])
    elif words == ["table"]:
        table()
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
