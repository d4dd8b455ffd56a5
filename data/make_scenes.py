#!/usr/bin/env python3
"""Writes the scenes of this folder. Only the standard library is needed.

    python3 data/make_scenes.py                      all scenes, into this folder
    python3 data/make_scenes.py --only cluttered --boxes 2000 --output /tmp/clutter.obj

Each scene is an OBJ with its MTL, in metres, y up; the city is an STL, a named solid an object. Kd is
linear reflectance, Ke is radiance in W/(m^2 sr). A line "# camera ..." is a camera that the program
reads.
"""
import argparse
import csv
import math
import pathlib
import random

HERE = pathlib.Path(__file__).resolve().parent


class Scene:
    """Polygons by object and material; corners counter-clockwise seen from the front."""

    def __init__(self, title, materials, camera=None):
        self.title, self.materials, self.camera = title, materials, camera
        self.faces = []  # (object, material, [points])

    def add(self, name, material, points):
        assert material in self.materials, material
        self.faces.append((name, material, [tuple(map(float, p)) for p in points]))

    def prism(self, name, material, base, y0, y1):
        """Closed upright prism over `base`, (x, z) corners counter-clockwise seen from below."""
        low = [(x, y0, z) for x, z in base]
        high = [(x, y1, z) for x, z in base]
        self.add(name, material, low)
        self.add(name, material, high[::-1])
        for k in range(len(base)):
            m = (k + 1) % len(base)
            self.add(name, material, [low[k], high[k], high[m], low[m]])

    def box(self, name, material, lower, upper, turn=0.0):
        """Axis-aligned box, turned by `turn` degrees about its vertical axis."""
        cx, cz = (lower[0] + upper[0]) / 2, (lower[2] + upper[2]) / 2
        c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        corners = [(lower[0], lower[2]), (upper[0], lower[2]), (upper[0], upper[2]),
                   (lower[0], upper[2])]
        base = [(cx + c * (x - cx) - s * (z - cz), cz + s * (x - cx) + c * (z - cz))
                for x, z in corners] if turn else corners
        self.prism(name, material, base, lower[1], upper[1])

    def cylinder(self, name, material, centre, radius, y0, y1, sides):
        base = [(centre[0] + radius * math.cos(2 * math.pi * k / sides),
                 centre[1] + radius * math.sin(2 * math.pi * k / sides)) for k in range(sides)]
        self.prism(name, material, base, y0, y1)

    def room(self, name, lower, upper, floor, walls, ceiling):
        """The inside of a box; one object per face."""
        (a, b, c), (d, e, f) = lower, upper
        self.add(name + "_floor", floor, [(a, b, c), (a, b, f), (d, b, f), (d, b, c)])
        self.add(name + "_ceiling", ceiling, [(a, e, c), (d, e, c), (d, e, f), (a, e, f)])
        self.add(name + "_north", walls, [(a, b, c), (d, b, c), (d, e, c), (a, e, c)])
        self.add(name + "_south", walls, [(a, b, f), (a, e, f), (d, e, f), (d, b, f)])
        self.add(name + "_west", walls, [(a, b, c), (a, e, c), (a, e, f), (a, b, f)])
        self.add(name + "_east", walls, [(d, b, c), (d, b, f), (d, e, f), (d, e, c)])

    def revolve(self, name, material, centre, profile, sides):
        """Surface of revolution about the vertical axis through `centre` = (x, z); `profile` is a
        list of (radius, y) going up, closed at both ends by radius 0."""
        def ring(radius, y):
            return [(centre[0] + radius * math.cos(2 * math.pi * k / sides), y,
                     centre[1] + radius * math.sin(2 * math.pi * k / sides))
                    for k in range(sides)]
        for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
            lower, upper = ring(r0, y0), ring(r1, y1)
            for k in range(sides):
                m = (k + 1) % sides
                if r0 == 0:
                    self.add(name, material, [(centre[0], y0, centre[1]), upper[k], upper[m]])
                elif r1 == 0:
                    self.add(name, material, [lower[k], (centre[0], y1, centre[1]), lower[m]])
                else:
                    self.add(name, material, [lower[k], upper[k], upper[m], lower[m]])

    def write_stl(self, path):
        """Polygons must be convex. Normals are left to readers, as the format allows: 0 0 0."""
        lines = []
        for solid in dict.fromkeys(name for name, _, _ in self.faces):
            lines.append(f"solid {solid}")
            for name, _, points in self.faces:
                for k in range(1, len(points) - 1) if name == solid else ():
                    lines += ["facet normal 0 0 0", " outer loop"]
                    lines += [" vertex {:g} {:g} {:g}".format(*p)
                              for p in (points[0], points[k], points[k + 1])]
                    lines += [" endloop", "endfacet"]
            lines.append(f"endsolid {solid}")
        pathlib.Path(path).write_text("\n".join(lines) + "\n")

    def write(self, path):
        path = pathlib.Path(path)
        number = lambda v: format(round(v, 9) + 0.0, ".9g")
        index, lines = {}, [f"# {self.title}", "# Written by make_scenes.py; units are metres.",
                            f"mtllib {path.with_suffix('.mtl').name}"]
        if self.camera:
            lines.append("# camera " + self.camera)
        body, last = [], (None, None)
        for name, material, points in self.faces:
            if name != last[0]:
                body.append(f"o {name}")
            if (name, material) != last:
                body.append(f"usemtl {material}")
            last = (name, material)
            keys = [" ".join(map(number, p)) for p in points]
            body.append("f " + " ".join(str(index.setdefault(k, len(index) + 1)) for k in keys))
        lines += ["v " + key for key in index] + body
        path.write_text("\n".join(lines) + "\n")
        used = {m for _, m, _ in self.faces}
        mtl = [f"# Materials of {path.name}: Kd linear reflectance, Ke radiance in W/(m^2 sr)."]
        for name, (kd, ke) in self.materials.items():
            if name in used:
                mtl += ["", f"newmtl {name}", "Kd " + " ".join(map(number, kd)),
                        "Ke " + " ".join(map(number, ke))]
        path.with_suffix(".mtl").write_text("\n".join(mtl) + "\n")


def grey(reflectance, radiance=0.0):
    return ((reflectance,) * 3, (radiance,) * 3)


# ---- The Cornell box, from the published measurements in cornell/ --------------------------------

def table(name):
    with open(HERE / "cornell" / name, newline="") as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def interpolate(samples, x):
    for (x0, y0), (x1, y1) in zip(samples, samples[1:]):
        if x0 <= x <= x1:
            return y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    raise ValueError(x)


# XYZ (CIE 1931) to linear RGB with Rec. 709 primaries and D65 white, IEC 61966-2-1.
XYZ_TO_RGB = ((3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570))


def cornell_colours():
    """Linear RGB: radiance of the lamp, and reflectance of each paint under the lamp.

    The illuminant is the published lamp spectrum S. Radiance is the RGB of S, scaled so that an
    equal-energy spectrum of radiance 1 has Y = 1. The reflectance of a paint rho is the RGB of
    rho S divided, band by band, by the RGB of S: light that leaves the lamp and is reflected once
    then has exactly the colour of the spectral calculation.
    """
    cmf = [(float(r["wavelength_nm"]), [float(r[k]) for k in "xyz"]) for r in table("cie1931.csv")]
    lamp = [(float(r["wavelength_nm"]), float(r["radiance"])) for r in table("light.csv")]
    paint = {k: [(float(r["wavelength_nm"]), float(r[k])) for r in table("reflectance.csv")]
             for k in ("white", "green", "red")}

    def rgb(spectrum):
        norm = sum(c[1] for _, c in cmf)
        xyz = [sum(spectrum(w) * c[k] for w, c in cmf) / norm for k in range(3)]
        return [sum(m * v for m, v in zip(row, xyz)) for row in XYZ_TO_RGB]

    light = rgb(lambda w: interpolate(lamp, w))
    colours = {"light": (tuple([0.78] * 3), tuple(light))}  # the lamp's own reflectance is published
    for name, samples in paint.items():
        lit = rgb(lambda w: interpolate(lamp, w) * interpolate(samples, w))
        reflectance = tuple(a / b for a, b in zip(lit, light))
        if not all(0 <= v <= 1 for v in reflectance):
            raise SystemExit(f"{name}: reflectance {reflectance} is outside 0 to 1 in Rec. 709")
        colours[name] = (reflectance, (0.0, 0.0, 0.0))
    return colours


def cornell(closed):
    # Published camera: at 278 273 -800 mm, focal length 35 mm, film 25 x 25 mm.
    fov = 2 * math.degrees(math.atan(12.5 / 35))
    scene = Scene("The Cornell box" + (", closed in front" if closed else ""), cornell_colours(),
                  f"eye=0.278,0.273,-0.8 target=0.278,0.273,0 up=0,1,0 fov={fov:.6f}")
    footprints = {}
    for row in table("geometry.csv"):
        quad = [tuple(float(row[a + str(i)]) / 1000 for a in "xyz") for i in range(1, 5)]
        scene.add(row["object"], row["material"], quad)
        if row["object"].endswith("block") and len({p[1] for p in quad}) == 1:
            footprints[row["object"]] = [(x, 0, z) for x, _, z in quad[::-1]]
    for name, quad in footprints.items():  # undersides, so that the blocks are closed solids
        scene.add(name, "white", quad)
    if closed:
        scene.add("front_wall", "white",
                  [(0.5528, 0, 0), (0.556, 0.5488, 0), (0, 0.5488, 0), (0, 0, 0)])
    return scene


# ---- Scenes with known answers ---------------------------------------------------------------------

def furnace_cube():
    scene = Scene("Unit cube seen from inside; rho = 0.5 and E = 1 everywhere: B = 2",
                  {"wall": grey(0.5, 1 / math.pi)})
    scene.room("cube", (0, 0, 0), (1, 1, 1), "wall", "wall", "wall")
    return scene


PLATES = {"lower": grey(0.5, 1.0), "upper": grey(0.5), "blocker": grey(0.0)}


def facing_plates():
    scene = Scene("Facing unit squares, gap 1: F = 0.199824895698387 (Howell C-11)", PLATES)
    scene.add("lower", "lower", [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)])
    scene.add("upper", "upper", [(0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)])
    return scene


def touching_plates():
    scene = Scene("Unit squares at a right angle, one edge shared: F = 0.200043776075403 "
                  "(Howell C-14)", PLATES)
    scene.add("lower", "lower", [(0, 0, 0), (0, 0, 1), (1, 0, 1), (1, 0, 0)])
    scene.add("upper", "upper", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)])
    return scene


def blocked_plates():
    scene = facing_plates()
    scene.title = ("Facing unit squares, gap 1, black square of side 0.5 half-way: "
                   "F = 0.0995062945990")
    ring = [(0.25, 0.5, 0.25), (0.25, 0.5, 0.75), (0.75, 0.5, 0.75), (0.75, 0.5, 0.25)]
    scene.add("blocker", "blocker", ring)
    scene.add("blocker", "blocker", ring[::-1])
    return scene


# ---- Rooms -----------------------------------------------------------------------------------------

def two_rooms():
    scene = Scene("Two rooms of 4 x 2.6 x 4 m, a doorway of 0.9 x 2 m in a wall 0.2 m thick; one lamp",
                  {"plaster": grey(0.7), "wood": ((0.45, 0.3, 0.18), (0, 0, 0)),
                   "lamp": grey(0.7, 20.0)},
                  "eye=7.9,1.6,0.3 target=3.2,1.1,2.2 up=0,1,0 fov=70")
    h, t, z0, z1 = 2.6, 2.0, 1.55, 2.45  # room height, door height, door jambs
    for name, a, d, door_at in (("lit", 0, 4, 4), ("dark", 4.2, 8.2, 4.2)):
        scene.add(name + "_floor", "wood", [(a, 0, 0), (a, 0, 4), (d, 0, 4), (d, 0, 0)])
        scene.add(name + "_ceiling", "plaster", [(a, h, 0), (d, h, 0), (d, h, 4), (a, h, 4)])
        scene.add(name + "_north", "plaster", [(a, 0, 0), (d, 0, 0), (d, h, 0), (a, h, 0)])
        scene.add(name + "_south", "plaster", [(a, 0, 4), (a, h, 4), (d, h, 4), (d, 0, 4)])
        door = [(0, 0), (h, 0), (h, 4), (0, 4), (0, z1), (t, z1), (t, z0), (0, z0)]  # (y, z)
        wall = [(door_at, y, z) for y, z in door]
        blank = [(0, 0), (h, 0), (h, 4), (0, 4)]
        if name == "lit":
            scene.add("lit_west", "plaster", [(0, y, z) for y, z in blank])
            scene.add("lit_door_wall", "plaster", wall[::-1])
        else:
            scene.add("dark_door_wall", "plaster", wall)
            scene.add("dark_east", "plaster", [(8.2, y, z) for y, z in blank[::-1]])
    scene.add("sill", "wood", [(4, 0, z0), (4, 0, z1), (4.2, 0, z1), (4.2, 0, z0)])
    scene.add("lintel", "plaster", [(4, t, z0), (4.2, t, z0), (4.2, t, z1), (4, t, z1)])
    scene.add("jamb_north", "plaster", [(4, 0, z0), (4.2, 0, z0), (4.2, t, z0), (4, t, z0)])
    scene.add("jamb_south", "plaster", [(4, 0, z1), (4, t, z1), (4.2, t, z1), (4.2, 0, z1)])
    scene.add("lamp", "lamp", [(1.6, h, 1.6), (2.4, h, 1.6), (2.4, h, 2.4), (1.6, h, 2.4)])
    return scene


def chair(scene, name, x, z, turn):
    """Seat 0.44 m square at 0.45 m, four legs and a back, turned about its middle."""
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))

    def part(lower, upper):
        corners = [(lower[0], lower[2]), (upper[0], lower[2]), (upper[0], upper[2]),
                   (lower[0], upper[2])]
        base = [(x + c * u - s * w, z + s * u + c * w) for u, w in corners]
        scene.prism(name, "chair", base, lower[1], upper[1])

    part((-0.22, 0.42, -0.22), (0.22, 0.45, 0.22))
    for u in (-0.21, 0.17):
        for w in (-0.21, 0.17):
            part((u, 0, w), (u + 0.04, 0.42, w + 0.04))
    part((-0.22, 0.45, 0.19), (0.22, 0.95, 0.22))


def furnished_room():
    rng = random.Random(7)
    materials = {
        "plaster": grey(0.75), "ceiling": grey(0.85), "parquet": ((0.42, 0.27, 0.15), (0, 0, 0)),
        "oak": ((0.5, 0.34, 0.2), (0, 0, 0)), "chair": ((0.35, 0.16, 0.1), (0, 0, 0)),
        "shade": ((0.75, 0.7, 0.6), (0, 0, 0)), "rug": ((0.45, 0.12, 0.1), (0, 0, 0)),
        "cup": grey(0.8), "lamp": ((0.8, 0.8, 0.8), (22.0, 19.0, 15.0)),
        "book0": ((0.5, 0.08, 0.07), (0, 0, 0)), "book1": ((0.08, 0.2, 0.45), (0, 0, 0)),
        "book2": ((0.1, 0.35, 0.14), (0, 0, 0)), "book3": ((0.55, 0.45, 0.15), (0, 0, 0)),
    }
    scene = Scene("A furnished room, 6 x 2.7 x 4.5 m", materials,
                  "eye=5.7,1.65,0.35 target=2.2,0.75,3.0 up=0,1,0 fov=62")
    scene.room("room", (0, 0, 0), (6, 2.7, 4.5), "parquet", "plaster", "ceiling")
    scene.add("rug", "rug", [(1.6, 0, 1.2), (1.6, 0, 3.6), (4.4, 0, 3.6), (4.4, 0, 1.2)])
    for x in (2.0, 4.0):
        scene.add("ceiling_lamp", "lamp",
                  [(x - 0.3, 2.7, 1.95), (x + 0.3, 2.7, 1.95), (x + 0.3, 2.7, 2.55),
                   (x - 0.3, 2.7, 2.55)])
    scene.box("table", "oak", (2.2, 0.71, 1.9), (3.8, 0.75, 2.9), 8)
    for u in (2.35, 3.57):
        for w in (2.05, 2.67):
            scene.box("table", "oak", (u, 0, w), (u + 0.08, 0.71, w + 0.08))
    chair(scene, "chair_a", 2.6, 3.2, 5)
    chair(scene, "chair_b", 3.4, 3.15, -12)
    chair(scene, "chair_c", 2.65, 1.6, 186)
    chair(scene, "chair_d", 3.45, 1.62, 171)
    for k, (x, z) in enumerate(((2.6, 2.25), (3.3, 2.6), (3.45, 2.2))):
        scene.cylinder(f"cup_{k}", "cup", (x, z), 0.04, 0.75, 0.84, 20)
    scene.revolve("vase", "cup", (3.0, 2.4),
                  [(0, 0.75), (0.05, 0.75), (0.08, 0.83), (0.075, 0.92), (0.04, 1.0), (0.05, 1.05),
                   (0, 1.05)], 24)
    shelves(scene, rng)
    scene.cylinder("stand", "oak", (5.4, 4.0), 0.18, 0, 0.03, 24)
    scene.cylinder("stand", "oak", (5.4, 4.0), 0.015, 0.03, 1.4, 12)
    scene.revolve("lampshade", "shade", (5.4, 4.0), [(0, 1.4), (0.22, 1.4), (0.13, 1.75), (0, 1.75)],
                  24)
    return scene


def shelves(scene, rng):
    """Three bookcases against the walls, their books standing on the boards."""
    for name, along_x, at in (("case_a", False, 0.9), ("case_b", True, 1.0), ("case_c", True, 3.4)):
        length, depth, height, board = 1.6, 0.3, 2.1, 0.025

        def place(u0, y0, v0, u1, y1, v1):
            return (((at + u0, y0, 4.5 - v1), (at + u1, y1, 4.5 - v0)) if along_x
                    else ((v0, y0, at + u0), (v1, y1, at + u1)))

        scene.box(name, "oak", *place(0, 0, 0, board, height, depth))
        scene.box(name, "oak", *place(length - board, 0, 0, length, height, depth))
        levels = [0.06 + 0.4 * k for k in range(6)]
        for y in levels:
            scene.box(name, "oak", *place(board, y, 0, length - board, y + board, depth))
        for y in levels[:-1]:
            u = board + 0.01
            while u < length - board - 0.08:
                thick, tall = rng.uniform(0.015, 0.045), rng.uniform(0.2, 0.33)
                if rng.random() < 0.85:
                    low, high = place(u, y + board, 0.02, u + thick, y + board + tall,
                                      rng.uniform(0.16, 0.24))
                    scene.box("books", f"book{rng.randrange(4)}", low, high)
                u += thick + (0 if rng.random() < 0.9 else 0.05)  # neighbours touch


def curved():
    scene = Scene("Tessellated sphere, vase and columns in a room",
                  {"plaster": grey(0.7), "stone": ((0.6, 0.55, 0.45), (0, 0, 0)),
                   "ball": ((0.2, 0.35, 0.6), (0, 0, 0)), "clay": ((0.6, 0.3, 0.18), (0, 0, 0)),
                   "lamp": grey(0.8, 15.0)},
                  "eye=2.9,1.5,0.2 target=1.2,0.7,2.0 up=0,1,0 fov=65")
    scene.room("room", (0, 0, 0), (3, 2.4, 3), "plaster", "plaster", "plaster")
    scene.add("lamp", "lamp", [(1.2, 2.4, 1.2), (1.8, 2.4, 1.2), (1.8, 2.4, 1.8), (1.2, 2.4, 1.8)])
    for k, (x, z) in enumerate(((0.5, 0.6), (0.5, 2.4), (2.5, 2.4))):
        scene.cylinder(f"column_{k}", "stone", (x, z), 0.18, 0, 2.4, 48)
    rings, r, y = 16, 0.45, 0.75
    sphere = [(0 if k in (0, rings) else r * math.sin(math.pi * k / rings),
               y - r * math.cos(math.pi * k / rings)) for k in range(rings + 1)]
    scene.revolve("ball", "ball", (1.5, 1.7), sphere, 32)
    vase = [(0, 0), (0.16, 0), (0.24, 0.12), (0.27, 0.3), (0.22, 0.5), (0.12, 0.62), (0.1, 0.7),
            (0.15, 0.8), (0, 0.8)]
    scene.revolve("vase", "clay", (2.3, 1.2), vase, 32)
    return scene


def cluttered(boxes):
    """Boxes of random size and turn at random places of a room, none touching a wall."""
    rng = random.Random(11)
    scene = Scene(f"{boxes} turned boxes in a room of 4 x 3 x 4 m",
                  {"plaster": grey(0.75), "lamp": grey(0.8, 20.0),
                   **{f"box{k}": (tuple(round(rng.uniform(0.15, 0.8), 3) for _ in range(3)),
                                  (0, 0, 0)) for k in range(6)}},
                  "eye=0.2,1.6,0.2 target=2.2,1.3,2.4 up=0,1,0 fov=75")
    scene.room("room", (0, 0, 0), (4, 3, 4), "plaster", "plaster", "plaster")
    scene.add("lamp", "lamp", [(1.5, 3, 1.5), (2.5, 3, 1.5), (2.5, 3, 2.5), (1.5, 3, 2.5)])
    cells = max(2, math.ceil((boxes / 0.75) ** (1 / 3)))  # one cell a box, so that none touch
    places = [(i, j, k) for i in range(cells) for j in range(cells) for k in range(cells)
              if (i, j, k) != (0, cells // 2, 0)]  # keep the camera's corner free
    for n, (i, j, k) in enumerate(rng.sample(places, boxes)):
        cell = (3.6 / cells, 2.6 / cells, 3.6 / cells)
        centre = [0.2 + (v + 0.5) * c for v, c in zip((i, j, k), cell)]
        half = [rng.uniform(0.2, 0.33) * c for c in cell]
        scene.box(f"box_{n:04d}", f"box{n % 6}", [c - h for c, h in zip(centre, half)],
                  [c + h for c, h in zip(centre, half)], rng.uniform(0, 90))
    return scene


def city():
    """Blocks on a square: party walls, a courtyard, a tower that looks down on all of them."""
    scene = Scene("six buildings on a ground of 80 x 80 m", {"wall": grey(0.3)})
    scene.add("ground", "wall", [(0, 0, 0), (0, 0, 80), (80, 0, 80), (80, 0, 0)])
    for name, (x0, z0), (x1, z1), height in [
            ("tower", (50, 52), (60, 62), 45), ("hall", (12, 50), (36, 66), 9),
            ("row_house_west", (14, 14), (24, 26), 10), ("row_house_middle", (24, 14), (34, 26), 12),
            ("row_house_east", (34, 14), (44, 26), 10), ("school", (52, 12), (66, 38), 14)]:
        scene.box(name, "wall", (x0, 0, z0), (x1, height, z1))
    return scene


SCENES = {
    "city": lambda a: city(),
    "cornell-box": lambda a: cornell(closed=False),
    "cornell-box-closed": lambda a: cornell(closed=True),
    "furnace-cube": lambda a: furnace_cube(),
    "facing-plates": lambda a: facing_plates(),
    "touching-plates": lambda a: touching_plates(),
    "blocked-plates": lambda a: blocked_plates(),
    "two-rooms": lambda a: two_rooms(),
    "furnished-room": lambda a: furnished_room(),
    "curved": lambda a: curved(),
    "cluttered": lambda a: cluttered(a.boxes),
}


def main():
    parser = argparse.ArgumentParser(description="Write the scenes of this folder.")
    parser.add_argument("--only", choices=sorted(SCENES), help="this scene alone")
    parser.add_argument("--output", help="where to write it (with --only)")
    parser.add_argument("--boxes", type=int, default=120,
                        help="boxes in the cluttered scene, 1 or more; 6 polygons each (%(default)s)")
    arguments = parser.parse_args()
    if arguments.output and not arguments.only:
        parser.error("--output goes with --only")
    if arguments.boxes < 1:
        parser.error("--boxes must be 1 or more")
    for name in [arguments.only] if arguments.only else SCENES:
        scene = SCENES[name](arguments)
        ending = "stl" if name == "city" else "obj"
        path = pathlib.Path(arguments.output or HERE / f"{name}.{ending}")
        (scene.write_stl if path.suffix == ".stl" else scene.write)(path)
        print(f"{path}: {len(scene.faces)} polygons")


if __name__ == "__main__":
    main()
