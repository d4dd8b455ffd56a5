"""Ctrl-C while form factors of a curved body in a room are computed: every stage answers soon and
leaves nothing behind but rows."""

import math
import random
import signal
import subprocess
import sys
import time
import unittest

from cli_runner import BOX_MTL, BOX_OBJ, PROGRAM, CliTest

# On a quiet machine the program answers within half a second. Tests run several at a time, on
# machines with other work, and the system may take a while to give back the memory.
LONGEST_ANSWER = 5.0

ROOM = BOX_OBJ + "o ball\nusemtl wall\n"


def bumpy_ball(rings, sectors):
    """Faces of a ball of which no two neighbours lie alike, as lines of an OBJ file."""
    chance = random.Random(1)
    lines = []
    for ring in range(1, rings):
        for sector in range(sectors):
            radius = chance.uniform(0.2, 0.3)
            polar, turn = math.pi * ring / rings, 2 * math.pi * sector / sectors
            x, y = math.sin(polar) * math.cos(turn), math.sin(polar) * math.sin(turn)
            lines.append(f"v {0.5 + radius * x:.6f} {0.5 + radius * y:.6f} "
                         f"{0.5 + radius * math.cos(polar):.6f}")
    lines += ["v 0.5 0.5 0.75", "v 0.5 0.5 0.25"]
    first, top = 9, 9 + (rings - 1) * sectors
    at = lambda ring, sector: first + (ring - 1) * sectors + sector % sectors
    for s in range(sectors):
        lines.append(f"f {top} {at(1, s)} {at(1, s + 1)}")
        lines.append(f"f {top + 1} {at(rings - 1, s + 1)} {at(rings - 1, s)}")
        for r in range(1, rings - 1):
            lines.append(f"f {at(r, s)} {at(r + 1, s)} {at(r + 1, s + 1)}")
            lines.append(f"f {at(r, s)} {at(r + 1, s + 1)} {at(r, s + 1)}")
    return "\n".join(lines) + "\n"


class InterruptTest(CliTest):
    def answer(self, method, seconds):
        # With so many pixels hemicubes take long on any machine.
        process = subprocess.Popen(
            [PROGRAM, "factors", "room.h5", "--method", method, "--resolution", "2048",
             "-o", "f.h5"], cwd=self.folder,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        time.sleep(seconds)
        self.assertIsNone(process.poll(), "the run ended before it was interrupted")
        process.send_signal(signal.SIGINT)
        start = time.monotonic()
        _, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 1, err)
        # Rows are kept as they are computed; before the first there is nothing to keep.
        kept = self.folder / "f.h5.rows"
        left = ("f.h5.rows keeps the rows; the same command goes on from them" if kept.exists()
                else "nothing was written")
        self.assertEqual(err.splitlines()[-1], f"radiosity: interrupted; {left}")
        kept.unlink(missing_ok=True)
        return time.monotonic() - start

    def test_every_stage_answers_ctrl_c_soon(self):
        self.write("box.mtl", BOX_MTL)
        self.write("room.obj", ROOM + bumpy_ball(40, 80))
        self.run_program("mesh", "room.obj", "-o", "room.h5")
        before = self.files()
        for method in ["exact", "hemicube"]:
            for seconds in [0.2, 0.5, 1, 2]:
                answer = self.answer(method, seconds)
                self.assertLess(answer, LONGEST_ANSWER, f"{method}, after {seconds} s")
                self.assertEqual(self.files(), before)


if __name__ == "__main__":
    sys.exit(unittest.main())
