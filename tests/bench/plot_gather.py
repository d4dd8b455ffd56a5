#!/usr/bin/env python3
"""Draws the gather method beside the matrix from the benchmark's files: plot_gather.py FOLDER

Reads gather-costs.csv, writes gather-costs.svg and .png, and the main figures as a Markdown table,
gather-costs.md. All axes are logarithmic. Above, a panel a mesh: seconds of one processor by
passes, the matrix (which has none) as a level line. Below, the error that is left. Last, memory by
patches.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter, NullLocator

# A colour and a mark for each method, told apart without colour too (palette: Okabe and Ito 2008).
STYLES = {
    "gather at vertices": ("#0072B2", "o", "-"),
    "gather at patches": ("#56B4E9", "v", "-"),
    "hemicube matrix": ("#E69F00", "s", "--"),
    "exact matrix": ("#D55E00", "D", "--"),
}
MEBIBYTE = 1024.0 * 1024.0


def seconds(row):
    return float(row["user_s"]) + float(row["system_s"])


def error(row):
    return float(row["relative_l2_reflected"])


def set_scales(axes, ticks):
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(ticks, [f"{tick:,}" for tick in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)


def draw_passes(axes, rows, value):
    most = max(int(r["passes"]) for r in rows)
    for method, (colour, mark, line) in STYLES.items():
        points = [(int(r["passes"]), value(r)) for r in rows if r["method"] == method]
        if not points:
            continue
        if points[0][0] == 0:
            axes.plot([1, most], [points[0][1]] * 2, color=colour, linestyle=line, linewidth=1.4)
        else:
            axes.plot(*zip(*points), color=colour, marker=mark, markersize=4.5, linewidth=1.4)
    set_scales(axes, [2**k for k in range(most.bit_length())])


def draw_memory(axes, rows):
    for method, (colour, mark, line) in STYLES.items():
        # The memory of gathering does not depend on the passes.
        points = {int(r["patches"]): int(r["bytes"]) / MEBIBYTE
                  for r in rows if r["method"] == method}
        axes.plot(*zip(*sorted(points.items())), color=colour, marker=mark, markersize=4.5,
                  linestyle=line, linewidth=1.4)
    set_scales(axes, sorted({int(r["patches"]) for r in rows}))


def write_table(path, rows, sizes):
    most = max(int(r["passes"]) for r in rows)
    shown = [p for p in (1, 4, 16) if p <= most]
    with open(path, "w") as out:
        out.write("| patches | | " + " | ".join(STYLES) + " |\n|---|---|" + "---|" * len(STYLES)
                  + "\n")
        for size in sizes:
            mine = [r for r in rows if r["patches"] == size]

            def cells(text):
                line = []
                for method in STYLES:
                    of = [r for r in mine if r["method"] == method]
                    if int(of[0]["passes"]) > 0:
                        of = [r for r in of if int(r["passes"]) in shown]
                    line.append(" / ".join(text(r) for r in of))
                return " | ".join(line)

            out.write(f"| {int(size):,} | seconds | {cells(lambda r: f'{seconds(r):.2g}')} |\n")
            out.write(f"| | error | {cells(lambda r: f'{100 * error(r):.2g}%')} |\n")
            memory = []
            for method in STYLES:
                last = [r for r in mine if r["method"] == method][-1]
                memory.append(f"{int(last['bytes']) / MEBIBYTE:.2g}")
            out.write(f"| | MiB | {' | '.join(memory)} |\n")


def main():
    folder = pathlib.Path(sys.argv[1])
    with open(folder / "gather-costs.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    sizes = list(dict.fromkeys(r["patches"] for r in rows))
    write_table(folder / "gather-costs.md", rows, sizes)

    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "radiosity", "svg.fonttype": "path"})
    columns = len(sizes) + 1
    figure, grid = plt.subplots(2, columns, figsize=(2.8 * columns, 5.2), squeeze=False,
                                layout="constrained")
    for column, size in enumerate(sizes):
        mine = [r for r in rows if r["patches"] == size]
        draw_passes(grid[0][column], mine, seconds)
        draw_passes(grid[1][column], mine, error)
        grid[0][column].set_title(f"{int(size):,} patches", fontsize=9.5)
        grid[1][column].set_xlabel("passes")
    draw_memory(grid[0][-1], rows)
    grid[0][-1].set_title("memory", fontsize=9.5)
    grid[0][-1].set_xlabel("patches")
    grid[0][0].set_ylabel("seconds, one processor")
    grid[1][0].set_ylabel("error of the light reflected (relL2)")
    grid[0][-1].set_ylabel("MiB")
    grid[1][-1].axis("off")
    for line in grid:  # the panels of one quantity share its scale
        limits = [axes.get_ylim() for axes in line[:-1]]
        for axes in line[:-1]:
            axes.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
    handles = [plt.Line2D([], [], color=colour, marker=mark if line == "-" else None, markersize=5,
                          linestyle=line, label=method + (", solved" if line != "-" else ""))
               for method, (colour, mark, line) in STYLES.items()]
    grid[1][-1].legend(handles=handles, loc="center", frameon=False, fontsize=9)
    for kind, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 110})):
        path = folder / f"gather-costs.{kind}"
        figure.savefig(path, facecolor="white", **options)
        print(f"plot: {path}")


if __name__ == "__main__":
    main()
