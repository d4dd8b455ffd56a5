"""lux.py LUX.exr X,Y...: the illuminance of pixels, as `render --show illuminance` has it, as a list.
lux.py LUX.exr --lines STEP WITHOUT.png WITH.png: of the pixels that lines change, the share that is beside a multiple
of STEP; and their number."""

import json
import pathlib
import sys

import numpy as np
from PIL import Image

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "cli"))
from exr_file import ExrFile  # noqa: E402

CHANGED = 40  # of 255
APART = .02  # of a step, what page and program may differ

values = ExrFile(pathlib.Path(sys.argv[1])).channels["illuminance"]
if sys.argv[2] != "--lines":
    places = [map(int, place.split(",")) for place in sys.argv[2:]]
    json.dump([float(values[y, x]) for x, y in places], sys.stdout)
else:
    step = float(sys.argv[3])
    without, lined = (np.asarray(Image.open(path).convert("RGB")).astype(int) for path in sys.argv[4:])
    changed = np.abs(without - lined).max(2) > CHANGED
    changed[[0, -1]] = changed[:, [0, -1]] = False
    # The least and largest of a pixel and its eight neighbours.
    around = np.stack([np.roll(values, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1)]) / step
    meets = np.floor(around.max(0) + APART) > np.floor(around.min(0) - APART)
    json.dump({"share": float(meets[changed].mean()), "count": int(changed.sum())}, sys.stdout)
