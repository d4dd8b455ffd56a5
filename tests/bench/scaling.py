#!/usr/bin/env python3
"""Time and memory against faces and against patches: scaling.py PROGRAM [SCENE.obj] [options]

The faces of a scene are cut into four, again and again, and `radiosity factors` runs on each size;
then on the scene as it is with more and more patches. Twice: with new vertices in the planes of the
faces, where meshing finds the polygons again, and moved out of them by a hundredth of an edge,
where every face stays a polygon of its own. Default scene: data/furnished-room.obj.

  --most FACES   of the largest; default 1000000
  --patches N    asked for while faces grow; default 5000
  --limit S      seconds that a run may take (--time-limit); default 600
  --out DIR      where scaling.csv, .md, .svg and .png go; default out/bench

Exit code 1 where a run failed for another reason than its time.
"""
import argparse
import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from tables import write_table

ROOT = pathlib.Path(__file__).resolve().parents[2]
MEBIBYTE = 1024.0 * 1024.0
TOLERANCE = "1e-2"
ROUGHNESS = 0.01  # of an edge
PATCHES = (1000, 2000, 5000, 10000, 20000)
STAGES = {"all_s": ("all", "#000000", "o"), "mesh_s": ("meshing", "#E69F00", "s"),
          "prepare_s": ("preparing and planning", "#009E73", "^"),
          "factors_s": ("form factors", "#0072B2", "D")}
COLUMNS = {key: key.replace("_", " ") for key in (
    "series", "faces", "patches_asked", "polygons", "patches", "method", *STAGES,
    "memory_mib", "error")}


class Triangles:
    """The triangles of an OBJ file, by material."""

    def __init__(self, path):
        self.vertices, self.faces, self.materials = [], [], []
        material = ""
        for line in path.read_text().splitlines():
            word, *rest = line.split() or [""]
            if word == "v":
                self.vertices.append(tuple(float(x) for x in rest[:3]))
            elif word == "usemtl":
                material = line
            elif word == "mtllib":
                self.library = line.replace(rest[0], str((path.parent / rest[0]).resolve()))
            elif word == "f":
                corners = [int(corner.split("/")[0]) for corner in rest]
                corners = [c - 1 if c > 0 else len(self.vertices) + c for c in corners]
                for b, c in zip(corners[1:], corners[2:]):
                    self.faces.append((corners[0], b, c))
                    self.materials.append(material)

    def quarter(self, rough):
        """Every triangle becomes four; `rough`: the vertices in between leave its plane."""
        middles, faces = {}, []

        def middle(a, b, normal):
            key = (min(a, b), max(a, b))
            if key not in middles:
                p, q = self.vertices[a], self.vertices[b]
                size = ROUGHNESS * math.dist(p, q) if rough else 0.0
                # Out of the plane, in or out by turns, the same for both faces of the edge.
                size *= 1 if (key[0] * 7919 + key[1]) % 2 else -1
                middles[key] = len(self.vertices)
                self.vertices.append(tuple((x + y) / 2 + size * n
                                           for x, y, n in zip(p, q, normal)))
            return middles[key]

        for a, b, c in self.faces:
            normal = unit_normal(self.vertices[a], self.vertices[b], self.vertices[c])
            ab, bc, ca = middle(a, b, normal), middle(b, c, normal), middle(c, a, normal)
            faces += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        self.faces = faces
        self.materials = [m for m in self.materials for _ in range(4)]

    def write(self, path):
        with open(path, "w") as out:
            out.write(getattr(self, "library", "") + "\n")
            out.writelines(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in self.vertices)
            last = None
            for face, material in zip(self.faces, self.materials):
                if material != last:
                    out.write(material + "\n")
                last = material
                out.write("f {} {} {}\n".format(*(c + 1 for c in face)))


def unit_normal(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return [x / length for x in n] if length > 0 else [0, 0, 0]


def measured(report):
    factors, mesh = report["form_factors"], report["mesh"]
    prepare = factors["seconds_plan"] + factors.get("seconds_prepare", 0)
    return {"faces": report["scene"]["faces"], "polygons": mesh["polygons"],
            "patches": mesh["patches"], "method": factors["method"],
            "mesh_s": report["stages"]["mesh"]["seconds"], "prepare_s": prepare,
            "factors_s": factors["seconds"] - prepare, "error": factors["error_figure"]}


def run(arguments, scene, patches, series):
    """A row of the table; none where the time did not suffice."""
    with tempfile.TemporaryDirectory(prefix="scaling-") as folder:
        report = pathlib.Path(folder) / "r.json"
        # A process in between, for the memory of this run alone.
        command = [sys.executable, __file__, "--measure", str(arguments.program), "factors",
                   str(scene), "--patches", str(patches), "--tolerance", TOLERANCE, "-o",
                   str(pathlib.Path(folder) / "x.h5"), "--report", str(report), "--time-limit",
                   f"{arguments.limit}s", "--quiet"]
        child = subprocess.run(command, capture_output=True, text=True)
        if child.returncode != 0:
            print(f"{series}, {patches} patches: {child.stderr.strip()}", flush=True)
            return None, "--time-limit" in child.stderr
        row = {"series": series, "patches_asked": patches, **json.loads(child.stdout),
               **measured(json.loads(report.read_text()))}
    print("  ".join(f"{key} {text(key, row[key])}" for key in COLUMNS), flush=True)
    return row, True


def measure(command):
    """Started by run(): prints the seconds and the largest memory of a command."""
    import time
    start = time.monotonic()
    child = subprocess.run(command, stdout=subprocess.DEVNULL)
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(json.dumps({"all_s": time.monotonic() - start,
                      "memory_mib": usage.ru_maxrss * 1024 / MEBIBYTE}))
    return child.returncode


def text(_, value):
    if isinstance(value, float):
        return f"{value:.2g}" if value < 10 else f"{value:,.0f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def draw(folder, rows):
    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "radiosity", "svg.fonttype": "path"})
    figure, grid = plt.subplots(2, 2, figsize=(9, 6), sharey="row", squeeze=False)
    titles = {"faces": "faces", "patches_asked": "patches asked for"}
    for column, (along, title) in enumerate(titles.items()):
        for series, style in (("in the planes", "--"), ("out of the planes", "-"),
                              ("patches", "-")):
            some = [r for r in rows if r["series"] == series]
            if not some or (series == "patches") != (along == "patches_asked"):
                continue
            x = [r[along] for r in some]
            for key, (label, colour, mark) in STAGES.items():
                grid[0][column].loglog(x, [max(r[key], 1e-3) for r in some], style, color=colour,
                                       marker=mark, markersize=4, label=label)
            grid[1][column].loglog(x, [r["memory_mib"] for r in some], style, color="#D55E00",
                                   marker="o", markersize=4)
        grid[1][column].set_xlabel(title)
        for line in (0, 1):
            grid[line][column].grid(True, which="major", color="#dddddd", linewidth=0.6)
    grid[0][0].set_title("new vertices in the planes of the faces (dashed), out of them", fontsize=9)
    grid[0][1].legend(fontsize=8)
    grid[0][0].set_ylabel("seconds, two threads")
    grid[1][0].set_ylabel("memory, MiB")
    figure.tight_layout()
    for kind in ("svg", "png"):
        figure.savefig(folder / f"scaling.{kind}", dpi=110, metadata={"Date": None} if kind == "svg"
                       else {})


def main():
    if sys.argv[1:2] == ["--measure"]:
        return measure(sys.argv[2:])
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path, nargs="?",
                        default=ROOT / "data/furnished-room.obj")
    parser.add_argument("--most", type=int, default=1_000_000)
    parser.add_argument("--patches", type=int, default=5000)
    parser.add_argument("--limit", type=int, default=600)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/bench"))
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows, good = [], True

    def add(scene, patches, series):
        nonlocal good
        row, timely = run(arguments, scene, patches, series)
        good = good and timely
        if row:
            rows.append(row)
            write_table(arguments.out, "scaling", COLUMNS, rows, text)

    with tempfile.TemporaryDirectory(prefix="scaling-") as folder:
        scene = pathlib.Path(folder) / "scene.obj"
        for series, rough in (("in the planes", False), ("out of the planes", True)):
            triangles = Triangles(arguments.scene)
            while len(triangles.faces) <= arguments.most:
                triangles.write(scene)
                add(scene, arguments.patches, series)
                triangles.quarter(rough)
    for patches in PATCHES:
        add(arguments.scene, patches, "patches")
    draw(arguments.out, rows)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
