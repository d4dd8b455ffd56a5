#!/usr/bin/env python3
"""Draws error against time from the benchmark's files: plot.py FOLDER

Reads error-against-time.csv and exact-against-rays.csv, writes error-against-time.svg and .png, and
the main figures as a Markdown table, error-against-time.md.
One panel a scene, both axes logarithmic: seconds of one processor for the form-factor stage, and
the area-weighted relL2 of F. Down and to the left is better. The ray caster's own power law is
continued as a dotted line.
"""
import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullFormatter

# A colour and a mark for each method, told apart without colour too (palette: Okabe and Ito 2008).
STYLES = {
    "hemicube": ("hemicube, 64 to 512 pixels", "#E69F00", "s"),
    "hemicube + near": ("hemicube, near pairs exact", "#009E73", "^"),
    "rays": ("ray casting (Embree, Sobol points)", "#0072B2", "o"),
    "exact": ("exact, tolerance 0.1 to 1e-5", "#D55E00", "D"),
}
TITLES = {
    "cornell-box-closed": "Cornell box, closed",
    "cluttered": "cluttered",
    "curved": "curved",
    "furnished-room": "furnished room",
}


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def seconds(row):
    return float(row["user_s"]) + float(row["system_s"])


def draw_scene(axes, rows, laws):
    for method, (_, colour, mark) in STYLES.items():
        points = sorted((seconds(r), float(r["relative_l2_F"])) for r in rows
                        if r["method"] == method)
        if points:
            axes.plot(*zip(*points), color=colour, marker=mark, markersize=4.5, linewidth=1.4)
    for law in {law["curve"]: law for law in laws}.values():
        start = max(seconds(r) for r in rows if r["method"] == law["curve"])
        goal = min(float(r["relative_l2_F"]) for r in rows)
        factor, slope = float(law["ray_factor"]), float(law["ray_slope"])
        end = (goal / factor) ** (1 / slope)
        axes.plot([start, end], [factor * start**slope, goal], color=STYLES[law["curve"]][1],
                  linewidth=1.2, linestyle=":")
    if left_out(rows):
        axes.text(0.97, 0.95, f"exact at {left_out(rows)} not run", fontsize=7, ha="right",
                  va="top", transform=axes.transAxes)
    axes.set_title(f"{TITLES[rows[0]['scene']]}, {int(rows[0]['patches']):,} patches",
                   fontsize=9.5)


def of(rows, method, value):
    return next((r for r in rows if r["method"] == method and float(r["value"]) == value), None)


def short(row, name):
    return f"{float(row[name]):.0e}".replace("e-0", "e-") if row and row[name] else "-"


def tightest(rows):
    return min((r for r in rows if r["method"] == "exact"), key=lambda r: float(r["value"]))


def left_out(rows):
    """Tolerances that the exact method was not run at, as text."""
    return ", ".join(f"{float(t):.0e}".replace("e-0", "e-")
                     for t in rows[0].get("exact_left_out", "").split())


def table_line(scene, patches, rows, laws):
    hemicube = of(rows, "hemicube", 256)
    exact = of(rows, "exact", 1e-3) or tightest(rows)
    loose = "" if float(exact["value"]) == 1e-3 else f" (at {short(exact, 'value')})"
    cells = [TITLES[scene], f"{int(patches):,}"]
    for row, remark in ((exact, loose), (hemicube, "")):
        cells += [f"{seconds(row):.2g} s{remark}" if row else "-", short(row, "relative_l2_F"),
                  short(row, "relative_l2_B")]
    for error in (1e-2, 1e-3):
        ratios = [float(law["ratio"]) for law in laws if float(law["error"]) == error]
        cells.append(" / ".join(f"{r:,.0f}x" if r >= 10 else f"{r:.1f}x" for r in ratios) or "-")
    return "| " + " | ".join(cells) + " |\n"


def write_table(path, scenes, measured, laws):
    with open(path, "w") as out:
        out.write("| scene | patches | exact, 1e-3 | F | B | hemicube, 256 | F | B "
                  "| rays at 1e-2 | rays at 1e-3 |\n|---|---|---|---|---|---|---|---|---|---|\n")
        notes = []
        for key in scenes:
            rows = [r for r in measured if (r["scene"], r["patches"]) == key]
            out.write(table_line(*key, rows,
                                 [r for r in laws if (r["scene"], r["patches"]) == key]))
            if left_out(rows):
                notes.append(f"{TITLES[key[0]]}, {int(key[1]):,} patches: exact at {left_out(rows)} "
                             f"left out, for {short(tightest(rows), 'value')} took "
                             f"{seconds(tightest(rows)):.0f} s.\n")
        out.writelines("\n" + note for note in notes)


def main():
    folder = pathlib.Path(sys.argv[1])
    measured = read(folder / "error-against-time.csv")
    laws = read(folder / "exact-against-rays.csv")
    scenes = list(dict.fromkeys((r["scene"], r["patches"]) for r in measured))

    write_table(folder / "error-against-time.md", scenes, measured, laws)

    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "radiosity", "svg.fonttype": "path"})
    # One place more, for the legend.
    columns = min(len(scenes) + 1, 3 if len(scenes) < 6 else 4)
    lines = -(-(len(scenes) + 1) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(3 * columns, 2.7 * lines + 0.3),
                                sharex=True, sharey=True, squeeze=False)
    places = list(grid.flat)
    for axes, (scene, patches) in zip(places, scenes):
        draw_scene(axes, [r for r in measured if (r["scene"], r["patches"]) == (scene, patches)],
                   [r for r in laws if (r["scene"], r["patches"]) == (scene, patches)])
    for axes in places[:len(scenes)]:
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.xaxis.set_major_locator(LogLocator(base=100, numticks=20))
        axes.xaxis.set_minor_locator(LogLocator(base=10, numticks=20))
        axes.yaxis.set_major_locator(LogLocator(base=10, subs=(1,), numticks=20))
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
        axes.grid(True, which="minor", axis="x", color="#dddddd", linewidth=0.6)
        axes.set_axisbelow(True)
    for place, axes in enumerate(places[:len(scenes)]):
        # Nothing below, or the legend: the panel carries the numbers itself.
        if place + columns >= len(scenes):
            axes.set_xlabel("seconds, one processor")
            axes.tick_params(labelbottom=True)
        if place % columns == 0:
            axes.set_ylabel("error of F (relL2)")
    for axes in places[len(scenes):]:
        axes.axis("off")
    handles = [plt.Line2D([], [], color=colour, marker=mark, markersize=5, label=label)
               for label, colour, mark in STYLES.values()]
    handles.append(plt.Line2D([], [], color=STYLES["rays"][1], linestyle=":",
                              label="ray casting, extrapolated\nby its own slope"))
    places[len(scenes)].legend(handles=handles, loc="center left", frameon=False, fontsize=9)
    figure.tight_layout()
    for kind, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 110})):
        path = folder / f"error-against-time.{kind}"
        figure.savefig(path, facecolor="white", **options)
        print(f"plot: {path}")


if __name__ == "__main__":
    main()
