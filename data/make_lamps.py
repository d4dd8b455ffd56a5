#!/usr/bin/env python3
"""Writes panel.ldt and street.ies, lamps of formulas: python3 data/make_lamps.py"""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent


def hats(angles, weight):
    """The integral of each angle's hat function times the weight, by the midpoint rule."""
    sums = [0.0] * len(angles)
    steps = 400
    for k in range(len(angles) - 1):
        width = angles[k + 1] - angles[k]
        for s in range(steps):
            t = (s + 0.5) / steps
            part = weight(math.radians(angles[k] + t * width)) * math.radians(width) / steps
            sums[k] += (1 - t) * part
            sums[k + 1] += t * part
    return sums


def flux(vertical, horizontal, intensity):
    """lm of what is bilinear between the angles."""
    down = hats(vertical, math.sin)
    around = hats(horizontal, lambda angle: 1.0)
    return sum(a * d * intensity(v, h) for h, a in zip(horizontal, around) for v, d in zip(vertical, down))


def panel(gamma, c):
    """A light panel 1.2 m long: narrower across (C0) than along (C90)."""
    power = 1.6 - 0.6 * math.sin(math.radians(c)) ** 2
    return max(0.0, math.cos(math.radians(gamma))) ** power


def write_panel():
    around = [15 * k for k in range(24)]
    gamma = [5 * k for k in range(19)]
    quarter = around[:7]
    scale = 1000 / (4 * flux(gamma, quarter, panel))  # cd for 1000 lm, all of which leave it
    header = ["radiosity", 2, 4, len(around), 15, len(gamma), 5, "a formula", "Panel 1200 x 300", 1, "panel.ldt", "",
              1200, 300, 50, 1200, 300, 0, 0, 0, 0, 100, 100, 1, 0, 1, -1, "LED", 4000, "4000 K", 80, 32]
    lines = [*header, *[1] * 10, *around, *gamma,
             *[f"{scale * panel(g, c):.2f}" for c in quarter for g in gamma]]
    (HERE / "panel.ldt").write_text("".join(f"{line}\n" for line in lines))


def street(gamma, c):
    """Two beams along the street (C0 and C180), to the side of C90."""
    off_axis = min(abs(c - 15), abs(c - 165))
    beam = math.exp(-((gamma - 62) / 14) ** 2 - (off_axis / 28) ** 2)
    side = 0.35 + 0.65 * max(0.0, math.sin(math.radians(c))) * math.sin(math.radians(gamma))
    return (1600 * beam + 260 * side) * (1 if gamma < 85 else 0.1)


def write_street():
    vertical = [2.5 * k for k in range(37)]
    around = [*range(90, 271, 10)]
    row = [" ".join(f"{street(v, h):.1f}" for v in vertical) for h in around]
    lines = ["IESNA:LM-63-2002", "[TEST] a formula", "[MANUFAC] radiosity", "[LUMINAIRE] Street lamp", "TILT=NONE",
             f"1 -1 1 {len(vertical)} {len(around)} 1 2 0.3 0.6 0", "1 1 60",
             " ".join(map(str, vertical)), " ".join(map(str, around)), *row]
    (HERE / "street.ies").write_text("".join(f"{line}\n" for line in lines))


write_panel()
write_street()
