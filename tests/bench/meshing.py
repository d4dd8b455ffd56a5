#!/usr/bin/env python3
"""How the time of meshing grows with the number of faces: meshing.py PROGRAM [--most FACES]

Terrains, spheres and cities of tests/everyday_scenes with 1,000 faces and more, three times as
many each time, go through `radiosity mesh`. A table gives seconds of processor and the exponent of
their growth from the smallest size that takes a tenth of a second, by least squares.

  --most FACES  of the largest; default 300000

Exit code 1 where an exponent is above 1.2: n log n between these sizes is 1.1.
"""
import argparse
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "everyday_scenes"))
import generators  # noqa: E402  (a folder of scripts, not a package)

MAKERS = [generators.terrain, generators.sphere, generators.city]
LEAST_SECONDS = 0.1
MOST_EXPONENT = 1.2


def processor_seconds(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def exponent(points):
    """Slope of log seconds over log faces."""
    x = [math.log(faces) for faces, _ in points]
    y = [math.log(seconds) for _, seconds in points]
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) /
            sum((a - mean_x) ** 2 for a in x))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--most", type=int, default=300_000)
    arguments = parser.parse_args()
    program = arguments.program.resolve()
    failed = False
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for make in MAKERS:
            points = []
            faces = 1000
            while faces <= arguments.most:
                scene = make(faces)
                path = scene.write(folder / make.__name__)
                seconds = processor_seconds([program, "mesh", path.name, "-o", "mesh.h5"],
                                            folder)
                print(f"{make.__name__:<10} {scene.face_count():>8} faces {seconds:8.2f} s",
                      flush=True)
                if seconds >= LEAST_SECONDS:
                    points.append((scene.face_count(), seconds))
                (folder / "mesh.h5").unlink()
                faces *= 3
            if len(points) > 1:
                grows = exponent(points)
                failed = failed or grows > MOST_EXPONENT
                print(f"{make.__name__:<10} exponent {grows:.2f}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
