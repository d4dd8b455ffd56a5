"""The penumbra of a lamp behind a bar, in pictures, beside its closed form."""
import csv
import math

import matplotlib.pyplot as plt

WIDTH = 512  # pixels, along x
HEIGHT = 8
REACH = 1.6  # metres to either side
LINE = 0.3  # y
BELOW_BAR = 0.95  # of the eye
HALF = 0.4  # of the bar
LAMP = (0.5, 1.0)
LAMP_HEIGHT = 2.0

SCENE = """mtllib penumbra.mtl
# camera eye=0,{line},{eye} target=0,{line},0 up=0,1,0 fov={fov}
"""
MATERIALS = """newmtl floor
Kd .5 .5 .5
newmtl bar
Kd 0 0 0
newmtl lamp
Kd 0 0 0
Ke 1 1 1
"""


def write_scene(folder):
    """A floor, a lamp 2 m above it, and half-way up a bar that hides all of it from |x| < .3."""
    rectangles = {"floor": (2.0, 2.0, 0.0, True), "bar": (HALF, 3.0, LAMP_HEIGHT / 2, False),
                  "lamp": (*LAMP, LAMP_HEIGHT, False)}
    fov = 2 * math.degrees(math.atan(REACH / BELOW_BAR * HEIGHT / WIDTH))
    text = SCENE.format(line=LINE, eye=BELOW_BAR, fov=fov)
    for k, (name, (x, y, z, up)) in enumerate(rectangles.items()):
        corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
        for cx, cy in corners if up else corners[::-1]:
            text += f"v {cx} {cy} {z}\n"
        text += f"o {name}\nusemtl {name}\nf " + " ".join(str(4 * k + c) for c in (1, 2, 3, 4)) + "\n"
    (folder / "penumbra.mtl").write_text(MATERIALS)
    scene = folder / "penumbra.obj"
    scene.write_text(text)
    return scene


def corner_factor(x, y, h):
    """From a point to a rectangle with a corner straight above it (Howell's catalogue, B-3)."""
    a, b = math.hypot(x, h), math.hypot(y, h)
    return (x / a * math.atan(y / a) + y / b * math.atan(x / b)) / (2 * math.pi)


def rectangle_factor(x0, x1, y0, y1):
    if x1 <= x0:
        return 0.0
    f = corner_factor
    h = LAMP_HEIGHT
    return f(x1, y1, h) - f(x0, y1, h) - f(x1, y0, h) + f(x0, y0, h)


def closed_form(x, y):
    """The bar takes a strip off the lamp that moves against the point."""
    a, b = LAMP
    start = min(max(-2 * HALF - x, -a), a)
    end = min(max(2 * HALF - x, -a), a)
    return (rectangle_factor(-a - x, start - x, -b - y, b - y)
            + rectangle_factor(end - x, a - x, -b - y, b - y))


def line_of(blocks):
    """Places along the line, and irradiance over the lamp's exitance, from a picture's pixels."""
    row = HEIGHT // 2
    y = LINE - 0.5 * 2 * REACH / WIDTH
    places = [((k + 0.5) / WIDTH * 2 - 1) * REACH for k in range(WIDTH)]
    # Radiance is rho E / pi, exitance pi Ke: with rho = .5 and Ke = 1 this is E / (pi / 2 pi).
    return places, y, [blocks[(k, row)]["green"] / 0.5 for k in range(WIDTH)]


def draw(folder, lines):
    """`lines`: name -> (places, y, values). Writes penumbra.csv, .svg and .png; returns the largest
    errors over the light below the lamp with nothing in between."""
    places, y, _ = next(iter(lines.values()))
    truth = [closed_form(x, y) for x in places]
    most = rectangle_factor(-LAMP[0], LAMP[0], -LAMP[1], LAMP[1])
    with open(folder / "penumbra.csv", "w", newline="") as out:
        table = csv.writer(out)
        table.writerow(["x", "closed form", *lines])
        table.writerows(zip(places, truth, *(values for _, _, values in lines.values())))
    figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5), sharex=True,
                                          height_ratios=(3, 2))
    above.plot(places, truth, color="black", linewidth=2.5, alpha=0.3, label="closed form")
    errors = {}
    for (name, (_, _, values)), colour in zip(lines.items(), ("#0072B2", "#D55E00", "#009E73")):
        above.plot(places, values, color=colour, linewidth=0.9, label=name)
        off = [(v - t) / most for v, t in zip(values, truth)]
        below.plot(places, [100 * o for o in off], color=colour, linewidth=0.9)
        errors[name] = max(map(abs, off))
    above.set_ylabel("irradiance / exitance of the lamp")
    above.legend(fontsize=8)
    below.set_ylabel("error, % of the light\nwith no bar, at x = 0")
    below.set_xlabel("x, m")
    figure.tight_layout()
    for kind in ("svg", "png"):
        figure.savefig(folder / f"penumbra.{kind}", dpi=110,
                       metadata={"Date": None} if kind == "svg" else {})
    return errors
