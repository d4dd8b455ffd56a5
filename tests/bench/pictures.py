#!/usr/bin/env python3
"""Error of pictures against processor time: pictures.py PROGRAM TRACER [options]

Pictures of 256 x 256 pixels by the cameras of scenes of data/, from scene file to picture on one
thread: patches alone (--elements off), more and more of them; elements, to finer and finer
tolerances, and of more patches; light at every pixel (--final-gather); a path tracer, with more and
more paths a pixel. The error is relL2 of linear radiance over means of 8 x 8 pixels, of blocks that
see neither lamp nor background. Truth is an independent path tracer's, TRACER, in every seventh
block, with independent sets of points that tell its own standard error; it is kept in the folder.
Then the penumbra of a lamp behind a bar along a line of points, whose truth is a closed form.

  --quick        fewer settings, and truth of fewer paths: a few minutes
  --scene NAME   this one alone
  --paths N      of truth, a block; default 262144, with --quick 32768
  --out DIR      where pictures.* and penumbra.* (.csv, .md, .svg, .png) and the truth go; default
                 out/bench

Exit code 1 where a run failed.
"""
import argparse
import csv
import hashlib
import json
import math
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import penumbra
from corpus import Finished
from tables import write_table

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ("cornell-box", "two-rooms", "curved", "furnished-room")
SIZE = 256
EVERY = 7
REPLICATES = 16
LIMIT = 3600  # seconds of a run
PATCHES = "patches"
ELEMENTS = "elements"
FEW = "elements of 1,000 patches"
MANY = "elements of more patches"
GATHER = "final gather"
PATHS = "path tracer"
SETTINGS = {
    PATCHES: (1000, 2000, 5000, 10000, 20000),
    ELEMENTS: (0.1, 0.03, 0.01, 0.003),
    FEW: (0.1, 0.03, 0.01),
    MANY: (6000, 12000, 20000),
    GATHER: (1000, 2000),  # patches
    PATHS: (1, 4, 16, 64, 256),
}
QUICK = {PATCHES: (1000, 5000), ELEMENTS: (0.03, 0.01), GATHER: (1000,), PATHS: (1, 16)}
PENUMBRA = {"patches, 2,000": ("--elements", "off"), "elements": (),
            "final gather": ("--final-gather",)}
STYLES = {PATCHES: ("#0072B2", "s"), ELEMENTS: ("#D55E00", "o"),
          FEW: ("#CC79A7", "v"), MANY: ("#E69F00", "P"), GATHER: ("#009E73", "D"),
          PATHS: ("#666666", "^")}
STAGES = {"mesh_s": "mesh", "factors_s": "factors", "solve_s": "solve", "elements_s": "elements",
          "rest_s": "picture and rest"}
COLUMNS = {"scene": "scene", "way": "way", "setting": "setting", "patches": "patches",
           "processor_s": "processor s", **STAGES, "error": "error", "bias": "mean difference",
           "truth_error": "error of truth"}


def read_blocks(path):
    with open(path) as lines:
        return {(int(r["x"]), int(r["y"])): {k: float(v) for k, v in r.items()}
                for r in csv.DictReader(lines)}


class Bench:
    def __init__(self, options, folder):
        self.program, self.tracer, self.out = options.program, options.tracer, options.out
        self.paths, self.folder = options.paths, folder
        self.good = True

    def run(self, command):
        """None if it failed, which is reported."""
        run = Finished([str(word) for word in command], self.folder, LIMIT)
        if run.code == 0:
            return run
        self.good = False
        print(f"{' '.join(map(str, command))}: exit code {run.code}: {run.err.strip()}",
              file=sys.stderr)
        return None

    def verify(self):
        """In a furnace, rho = .5 and exitance 1 all around, radiance is 2 / pi."""
        blocks = self.folder / "furnace.csv"
        if self.run([self.tracer, "trace", ROOT / "data/furnace-cube.obj", "--camera",
                     "eye=.3,.4,.5;target=.9,.5,.4", "--size", 64, "--paths", 4096, "--blocks",
                     blocks]) is None:
            return
        mean = sum(b["green"] for b in read_blocks(blocks).values()) / 64
        # 262,144 paths, each off by less than its whole light: a standard error below .2%.
        if abs(mean * math.pi / 2 - 1) > 0.005:
            self.good = False
            print(f"path tracer: {mean:g} W/m^2/sr in a furnace of 2 / pi", file=sys.stderr)

    def truth(self, scene):
        """Blocks of the truth, traced if the folder has none of the same scene and tracer."""
        file = ROOT / "data" / f"{scene}.obj"
        made_of = hashlib.sha256()
        for part in (file, file.with_suffix(".mtl"), *sorted((ROOT / "tests/bench/path_tracer")
                                                             .glob("*.[ch]*"))):
            made_of.update(part.read_bytes())
        kept = self.out / "pictures-truth"
        kept.mkdir(exist_ok=True)
        blocks = kept / f"{scene}-{self.paths}-{made_of.hexdigest()[:12]}.csv"
        if not blocks.exists():
            print(f"{scene}: tracing {self.paths:,} paths a block", flush=True)
            fresh = self.folder / "truth.csv"
            run = self.run([self.tracer, "trace", file, "--size", SIZE, "--every", EVERY, "--paths",
                            self.paths, "--replicates", REPLICATES, "--threads", 0, "--blocks",
                            fresh])
            if run is None:
                return None
            blocks.write_text(fresh.read_text())
        return {at: b for at, b in read_blocks(blocks).items() if b["plain"]}

    def traced(self, scene, paths):
        blocks = self.folder / "blocks.csv"
        run = self.run([self.tracer, "trace", ROOT / "data" / f"{scene}.obj", "--size", SIZE,
                        "--paths", 64 * paths, "--picture", self.folder / "p.exr", "--blocks",
                        blocks])
        return run and ({"processor_s": json.loads(run.out)["processor_s"]}, read_blocks(blocks))

    def rendered(self, scene, *options):
        """Processor seconds with their shares by stage, and the blocks."""
        picture, report = self.folder / "p.exr", self.folder / "r.json"
        run = self.run([self.program, "render", ROOT / "data" / f"{scene}.obj", "-o", picture,
                        "--width", SIZE, "--height", SIZE, "--threads", 1, "--report", report,
                        *options])
        if run is None:
            return None
        said = json.loads(report.read_text())
        stages, elements = said["stages"], said.get("elements", {})
        gather = said.get("final_gather", {})
        row = {"processor_s": run.processor_seconds, "patches": said["mesh"]["patches"],
               "mesh_s": stages["mesh"]["seconds"], "factors_s": stages["form_factors"]["seconds"],
               "solve_s": stages["solution"]["seconds"],
               "elements_s": sum(of.get(key, 0) for of, key in (
                   (elements, "seconds_direct"), (elements, "seconds_indirect"),
                   (gather, "seconds_sources"), (gather, "seconds")))}
        # Stages are timed by the clock, which also runs while others have the processor.
        share = run.processor_seconds / run.seconds
        for key in ("mesh_s", "factors_s", "solve_s", "elements_s"):
            row[key] *= share
        row["rest_s"] = row["processor_s"] - sum(row[k] for k in STAGES if k != "rest_s")
        blocks = self.folder / "blocks.csv"
        if self.run([self.tracer, "blocks", picture, "--blocks", blocks]) is None:
            return None
        return row, read_blocks(blocks)

    def draw_penumbra(self):
        scene, picture = penumbra.write_scene(self.folder), self.folder / "p.exr"
        blocks, lines = self.folder / "blocks.csv", {}
        for name, options in PENUMBRA.items():
            if (self.run([self.program, "render", scene, "-o", picture, "--width", penumbra.WIDTH,
                          "--height", penumbra.HEIGHT, *options])
                    and self.run([self.tracer, "blocks", picture, "--block", 1, "--blocks",
                                  blocks])):
                lines[name] = penumbra.line_of(read_blocks(blocks))
        if lines:
            for name, error in penumbra.draw(self.out, lines).items():
                print(f"penumbra, {name}: off by {100 * error:.2g}% of the light at most")

    def measure(self, scene, way, setting):
        if way == PATHS:
            return self.traced(scene, setting)
        if way == PATCHES:
            return self.rendered(scene, "--elements", "off", "--patches", setting)
        if way == GATHER:
            return self.rendered(scene, "--final-gather", "--patches", setting)
        if way == MANY:
            return self.rendered(scene, "--patches", setting)
        few = ("--patches", 1000) if way == FEW else ()
        return self.rendered(scene, "--element-tolerance", setting, *few)


def errors(blocks, truth):
    """relL2, and the mean difference over the mean."""
    squares = norm = difference = mean = noise = 0.0
    for at, true in truth.items():
        for band in ("red", "green", "blue"):
            off = blocks[at][band] - true[band]
            squares += off * off
            difference += off
            norm += true[band] ** 2
            mean += true[band]
            noise += true[f"{band}_error"] ** 2
    return {"error": math.sqrt(squares / norm), "bias": difference / mean,
            "truth_error": math.sqrt(noise / norm)}


def text(key, value):
    if value is None:
        return ""
    if key in ("error", "truth_error"):
        return f"{100 * value:.2g}%"
    if key == "bias":
        return f"{100 * value:+.2f}%"
    if isinstance(value, float):
        return f"{value:.2g}" if value < 10 else f"{value:,.0f}"
    return f"{value:,}" if isinstance(value, int) else str(value)


def draw(folder, rows):
    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "radiosity", "svg.fonttype": "path"})
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure, grid = plt.subplots(math.ceil(len(scenes) / 2), 2, figsize=(9, 3.4 * math.ceil(
        len(scenes) / 2)), sharey=True, squeeze=False)
    for axes in grid.flat[len(scenes):]:
        axes.set_visible(False)
    for scene, axes in zip(scenes, grid.flat):
        for way, (colour, mark) in STYLES.items():
            some = [r for r in rows if r["scene"] == scene and r["way"] == way]
            axes.loglog([r["processor_s"] for r in some], [100 * r["error"] for r in some],
                        color=colour, marker=mark, markersize=4, label=way)
            for row in some[:1] + some[1:][-1:]:
                axes.annotate(f"{row['setting']:,}" if row["setting"] >= 1 else
                              f"{row['setting']:g}", (row["processor_s"], 100 * row["error"]),
                              textcoords="offset points", xytext=(4, 3), fontsize=6.5, color=colour)
        truth = next(r["truth_error"] for r in rows if r["scene"] == scene)
        axes.axhline(100 * truth, color="#999999", linewidth=0.7, linestyle=":")
        axes.set_title(scene, fontsize=9)
        axes.set_xlabel("processor seconds, scene to picture")
        axes.grid(True, which="major", color="#dddddd", linewidth=0.6)
    for line in grid:
        line[0].set_ylabel("error of blocks, %")
    grid[0][0].legend(fontsize=8)
    figure.tight_layout()
    for kind in ("svg", "png"):
        figure.savefig(folder / f"pictures.{kind}", dpi=110,
                       metadata={"Date": None} if kind == "svg" else {})


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("tracer", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--scene", choices=SCENES)
    parser.add_argument("--paths", type=int)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/bench"))
    options = parser.parse_args()
    options.paths = options.paths or (32768 if options.quick else 262144)
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    with tempfile.TemporaryDirectory(prefix="pictures-") as folder:
        bench = Bench(options, pathlib.Path(folder))
        bench.verify()
        for scene in SCENES if options.scene is None else (options.scene,):
            truth = bench.truth(scene)
            for way, settings in (QUICK if options.quick else SETTINGS).items():
                for setting in settings if truth else ():
                    found = bench.measure(scene, way, setting)
                    if found is None:
                        continue
                    row, blocks = found
                    rows.append({"scene": scene, "way": way, "setting": setting, **row,
                                 **errors(blocks, truth)})
                    print("  ".join(f"{k} {text(k, rows[-1].get(k))}" for k in COLUMNS), flush=True)
                    write_table(options.out, "pictures", COLUMNS, rows, text)
        bench.draw_penumbra()
    if rows:
        draw(options.out, rows)
    return 0 if bench.good else 1


if __name__ == "__main__":
    sys.exit(main())
