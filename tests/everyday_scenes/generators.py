"""Scenes of the kinds that people have, each with the trouble its kind brings.

Every function takes the number of faces aimed at and gives a scene to write. They are deterministic:
chance comes from a fixed seed. Lengths are the file's own units. FULL_SIZE says how many faces such
files have in earnest.
"""

import math

import numpy as np

from scene_text import LinkedScene, SceneText

SEED = 20240607


def cad_export(faces):
    """A drilled plate with a press-fitted pin in every hole, as a CAD kernel exports it: every
    triangle has corners of its own with six digits. Slivers 1 : 5000 on the pins, fans from one
    corner on their ends; pin and hole have one radius and other angles, so their facets cross along
    the whole fit; the rim has corners where the top has none (T-junctions)."""
    segments, pitch, radius = 32, 20.0, 5.0
    side = max(1, round(math.sqrt(faces / 260)))
    scene = SceneText(share=False, digits=6)

    def ring(cx, cy, z, phase):
        angle = 2 * np.pi * (np.arange(segments) + phase) / segments
        return np.stack([cx + radius * np.cos(angle), cy + radius * np.sin(angle),
                         np.full(segments, z)], axis=1)

    def tube(low, high, inward):
        for k in range(segments):
            a, b, c, d = low[k], low[(k + 1) % segments], high[(k + 1) % segments], high[k]
            for triangle in ((a, b, c), (a, c, d)):
                scene.face(*(reversed(triangle) if inward else triangle))

    def tile(hole, cx, cy, z, up):
        h = pitch / 2
        corners = [(cx + x, cy + y, z) for x, y in ((h, h), (-h, h), (-h, -h), (h, -h))]
        for k in range(segments):
            after = hole[(k + 1) % segments]
            corner = corners[k * 4 // segments]
            fan = [(hole[k], corner, after)]
            if (k + 1) % (segments // 4) == 0:
                fan.append((after, corner, corners[((k + 1) * 4 // segments) % 4]))
            for triangle in fan:
                scene.face(*(triangle if up else reversed(triangle)))

    scene.group("plate")
    for i in range(side):
        for j in range(side):
            low, high = (ring(i * pitch, j * pitch, z, 0) for z in (0, 12))
            tile(low, i * pitch, j * pitch, 0, up=False)
            tile(high, i * pitch, j * pitch, 12, up=True)
            tube(low, high, inward=True)
    first, last = -pitch / 2, (side - 0.5) * pitch
    rim = [(first, first), (last, first), (last, last), (first, last)]
    for (ax, ay), (bx, by) in zip(rim, rim[1:] + rim[:1]):
        steps = 2 * side + 1
        along = [(ax + (bx - ax) * t / steps, ay + (by - ay) * t / steps, 0)
                 for t in range(steps + 1)]
        for p, q in zip(along, along[1:]):
            scene.face(p, q, (ax, ay, 12))
        scene.face(along[-1], (bx, by, 12), (ax, ay, 12))
    scene.group("pins", "dark")
    for i in range(side):
        for j in range(side):
            low, high = (ring(i * pitch, j * pitch, z, 0.37) for z in (-200, 300))
            tube(low, high, inward=False)
            for k in range(1, segments - 1):
                scene.face(high[0], high[k], high[k + 1])
                scene.face(low[0], low[k + 1], low[k])
    scene.lamp((0, 0, 400), 100)
    return scene


def doubled_house(faces):
    """A row of semi-detached houses as SketchUp exports them with two-sided faces: every face is
    there twice, front and back; walls have no thickness; a wall with its window is one polygon with
    a bridge to the hole; neighbours share a wall, which is there four times; floors lie in the plane
    of the ground; panes stand in the plane of the wall. Inches."""
    houses = max(1, round(faces / 26))
    scene = SceneText()

    def doubled(*corners):
        scene.face(*corners)
        scene.face(*reversed(corners))

    width, depth, height, ridge = 240.0, 300.0, 108.0, 180.0

    def wall(a, b):
        """From a to b on the ground, with a window."""
        def at(t, z):
            return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, z)
        window = [at(0.3, 36), at(0.3, 84), at(0.7, 84), at(0.7, 36)]
        scene.group("walls")
        doubled(at(0, 0), at(1, 0), at(1, height), at(0, height), at(0, 0), *window, window[0])
        scene.group("panes", "green")
        doubled(*reversed(window))

    for k in range(houses):
        x0, x1 = k * width, (k + 1) * width
        for a, b in (((x0, 0), (x1, 0)), ((x1, 0), (x1, depth)), ((x1, depth), (x0, depth)),
                     ((x0, depth), (x0, 0))):
            wall(a, b)
        middle = depth / 2
        scene.group("gables")
        for x in (x0, x1):
            doubled((x, 0, height), (x, depth, height), (x, middle, ridge))
        scene.group("roof", "red")
        for y in (-24, depth + 24):
            eaves = height - 24 * (ridge - height) / middle
            doubled((x0, y, eaves), (x1, y, eaves), (x1, middle, ridge), (x0, middle, ridge))
        scene.group("floor")
        doubled((x0, 0, 0), (x1, 0, 0), (x1, depth, 0), (x0, depth, 0))
    scene.group("ground", "green")
    doubled((-600, -600, 0), (houses * width + 600, -600, 0), (houses * width + 600, 900, 0),
            (-600, 900, 0))
    scene.lamp((width / 2, middle, 100), 24)
    return scene


def photogrammetry(faces):
    """A scanned rock: a triangle soup whose neighbours miss each other by noise, with holes, flipped
    and doubled triangles, some without area, some through others, and fragments in the air."""
    random = np.random.default_rng(SEED)
    rows = max(4, round(math.sqrt(faces / 4)))
    scene = SceneText(share=False, digits=7)
    scene.group("scan")
    theta = np.pi * np.arange(rows + 1) / rows
    phi = 2 * np.pi * np.arange(2 * rows + 1) / (2 * rows)
    bumps = random.normal(size=(12, 3)) * 4
    phase = random.uniform(0, 6, 12)

    def point(i, j):
        p = np.array([math.sin(theta[i]) * math.cos(phi[j]), math.sin(theta[i]) * math.sin(phi[j]),
                      math.cos(theta[i])])
        return p * (1 + 0.03 * np.sin(bumps @ p + phase).sum())

    for i in range(rows):
        for j in range(2 * rows):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            for triangle in ((a, b, c), (a, c, d)):
                corners = np.array(triangle) + random.normal(size=(3, 3)) * 1e-3 / rows
                chance = random.uniform()
                if chance < 0.02:
                    continue
                if chance < 0.03:
                    corners = corners[::-1]
                if chance > 0.99:
                    corners[2] = corners[1] if chance > 0.995 else (corners[0] + corners[1]) / 2
                if chance > 0.98:
                    scene.face(*corners)
                scene.face(*corners)
    scene.group("fragments", "dark")
    for _ in range(max(4, round(faces / 100))):
        middle = random.normal(size=3) * 0.8
        scene.face(*(middle + random.normal(size=(3, 3)) * 2 / rows))
    scene.lamp((0, 0, 3), 1)
    return scene


def city(faces):
    """Blocks of terraced houses, each a closed box that shares walls with its neighbours, some of one
    height, so that roofs lie in one plane; all stand on one ground that nobody cut."""
    random = np.random.default_rng(SEED)
    side = max(2, round(math.sqrt(faces / 6)))
    scene = SceneText()
    scene.group("ground", "dark")
    extent = side * 12.0 + 40
    scene.face((-40, -40, 0), (extent, -40, 0), (extent, extent, 0), (-40, extent, 0))
    for i in range(side):
        for j in range(side):
            x, y = i * 10.0 + (i // 4) * 8, j * 12.0 + (j // 2) * 8
            scene.group(f"house_{i}_{j}", "red" if (i + j) % 3 else "plain")
            scene.box((x, y, 0), (x + 10, y + 12, float(random.choice([6, 9, 9, 12, 15]))))
    return scene


def linked_duplicates(faces):
    """A hall of chairs as Blender exports linked duplicates: one mesh, many nodes, turned, scaled
    unevenly, mirrored; chairs pushed into each other; every eleventh is there twice in one place, as
    Shift-D leaves it. Two-sided materials; glTF."""
    random = np.random.default_rng(SEED)
    parts = SceneText()
    parts.group("chair", "red")
    parts.box((-0.2, 0.42, -0.2), (0.2, 0.45, 0.2))
    parts.box((-0.2, 0.45, 0.17), (0.2, 0.9, 0.2))
    for x in (-0.2, 0.17):
        for z in (-0.2, 0.17):
            parts.box((x, 0, z), (x + 0.03, 0.42, z + 0.03))
    count = max(2, round(faces / 72))
    side = math.ceil(math.sqrt(count))
    hall = side * 0.6 + 1
    parts.group("hall")
    parts.box((-1, 0, -1), (hall, 3, hall), inward=True)
    parts.group("light", "lamp")
    parts.face((0, 2.9, 0), (hall - 1, 2.9, 0), (hall - 1, 2.9, hall - 1), (0, 2.9, hall - 1))
    scene = LinkedScene(parts)
    scene.node("hall", 1, np.eye(4))
    scene.node("light", 2, np.eye(4))
    for k in range(count):
        angle = random.uniform(0, 2 * np.pi)
        c, s = math.cos(angle), math.sin(angle)
        mirror = -1 if k % 7 == 1 else 1
        matrix = np.array([[c * mirror, 0, s, 0.6 * (k % side)], [0, random.uniform(0.9, 1.1), 0, 0],
                           [-s * mirror, 0, c, 0.6 * (k // side)], [0, 0, 0, 1]])
        scene.node(f"chair.{k:03}", 0, matrix)
        if k % 11 == 2:
            scene.node(f"chair.{k:03}.copy", 0, matrix)
    return scene


def text_geometry(faces):
    """Extruded letters: ends are polygons of up to 200 corners, concave or with a bridge to a hole;
    sides are thin quads, a bevel goes around, and neighbours touch or overlap (kerning)."""
    scene = SceneText()
    arc = 24

    def curve(cx, cy, radius, start, end):
        angle = np.linspace(start, end, arc + 1)
        return [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in angle]

    half_turn, turn = np.pi, 2 * np.pi
    letters = {  # outline counter-clockwise, hole clockwise, advance
        "L": ([(0, 0), (0.6, 0), (0.6, 0.15), (0.15, 0.15), (0.15, 1), (0, 1)], [], 0.6),
        "I": ([(0, 0), (0.15, 0), (0.15, 1), (0, 1)], [], 0.15),
        "T": ([(0.25, 0), (0.4, 0), (0.4, 0.85), (0.65, 0.85), (0.65, 1), (0, 1), (0, 0.85),
               (0.25, 0.85)], [], 0.6),
        "O": (curve(0.5, 0.5, 0.5, 0, turn)[:-1], curve(0.5, 0.5, 0.35, 0, -turn)[:-1], 1.0),
        "C": (curve(0.5, 0.5, 0.5, 0.7, turn - 0.7) + curve(0.5, 0.5, 0.35, turn - 0.7, 0.7), [],
              0.8),
        "U": ([(0, 1), *curve(0.4, 0.4, 0.4, half_turn, turn), (0.8, 1), (0.65, 1),
               *curve(0.4, 0.4, 0.25, 0, -half_turn), (0.15, 1)], [], 0.8)}

    def inset(loop, by):
        """Each corner moved inward along the mean of its edges' normals."""
        points = np.array(loop)
        along = np.roll(points, -1, axis=0) - points
        along /= np.linalg.norm(along, axis=1)[:, None]
        normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
        mean = normal + np.roll(normal, 1, axis=0)
        return points + by * mean / np.maximum(1e-3, (mean * mean).sum(axis=1) / 2)[:, None]

    def letter(name, x):
        outline, hole, advance = letters[name]
        scene.group(f"{name}_{x:.2f}", "plain")
        caps = []
        for loop in (outline, hole):
            if not loop:
                continue
            rings = [[(x + px, py, z) for px, py in ring] for ring, z in
                     ((inset(loop, 0.01), 0.0), (loop, 0.01), (loop, 0.19), (inset(loop, 0.01), 0.2))]
            for low, high in zip(rings, rings[1:]):
                for k in range(len(loop)):
                    n = (k + 1) % len(loop)
                    scene.face(low[k], low[n], high[n], high[k])
            caps.append((rings[3], rings[0]))
        front, back = list(caps[0][0]), list(caps[0][1])
        if hole:
            front += [front[0], *caps[1][0], caps[1][0][0]]
            back += [back[0], *caps[1][1], caps[1][1][0]]
        scene.face(*front)
        scene.face(*reversed(back))
        return x + advance

    x = 0.0
    word = 0
    while scene.face_count() < faces:
        x = letter("OITLCU"[word % 6], x)
        word += 1
    scene.group("wall", "dark")
    scene.face((-1, -1, 0), (x + 1, -1, 0), (x + 1, 2, 0), (-1, 2, 0))
    scene.lamp((x / 2, 0.5, 2), 1)
    return scene


def leaf_cards(faces):
    """A tree: tapered branches, open tubes that begin inside their parents, and leaves of two quads
    through each other, many through branches and other leaves."""
    random = np.random.default_rng(SEED)
    scene = SceneText(digits=6)

    def frame(direction):
        d = direction / np.linalg.norm(direction)
        u = np.cross(d, [0.3, 0.5, 0.8] if abs(d[2]) > 0.9 else [0, 0, 1])
        u /= np.linalg.norm(u)
        return u, np.cross(d, u)

    def branch(base, tip, radius):
        u, v = frame(tip - base)
        turns = [np.cos(a) * u + np.sin(a) * v for a in 2 * np.pi * np.arange(7) / 7]
        for k in range(7):
            a, b = turns[k], turns[(k + 1) % 7]
            scene.face(base + radius * a, base + radius * b, tip + radius / 2 * b,
                       tip + radius / 2 * a)

    tips = []

    def grow(base, direction, length, radius, level):
        tip = base + direction * length
        branch(base, tip, radius)
        if level == 0:
            tips.append(tip)
            return
        for _ in range(3):
            d = direction + random.normal(size=3) * 0.5
            grow(base + direction * length * random.uniform(0.6, 0.95), d / np.linalg.norm(d),
                 length * 0.65, radius * 0.5, level - 1)

    scene.group("bark", "dark")
    levels = max(1, round(math.log(faces / 15, 3)) - 1)
    grow(np.zeros(3), np.array([0.0, 0, 1]), 2.0, 0.2, levels)
    scene.group("leaves", "green")
    while scene.face_count() < faces:
        middle = tips[random.integers(len(tips))] + random.normal(size=3) * 0.25
        u, v = frame(random.normal(size=3))
        w = np.cross(u, v)
        for side in (v, w):
            u_, s = u * 0.1, side * 0.05
            scene.face(middle - u_ - s, middle + u_ - s, middle + u_ + s, middle - u_ + s)
    scene.group("ground", "plain")
    scene.face((-5, -5, 0), (5, -5, 0), (5, 5, 0), (-5, 5, 0))
    scene.lamp((0, 0, 8), 2)
    return scene


def terrain(faces):
    """A height map in map coordinates: quads that are not planar, a lake that is, and numbers whose
    first digits are all alike."""
    random = np.random.default_rng(SEED)
    side = max(2, round(math.sqrt(faces)))
    scene = SceneText(digits=10)
    scene.group("terrain", "green")
    waves = random.normal(size=(10, 2)) * 6 / side
    phase = random.uniform(0, 6, 10)

    def point(i, j):
        height = 4 * np.sin(waves @ (i, j) + phase).sum()
        return (500000 + 10.0 * i, 5200000 + 10.0 * j, max(height, -3.0))

    for i in range(side):
        for j in range(side):
            scene.face(point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1))
    scene.lamp((500000 + 5 * side, 5200000 + 5 * side, 10.0 * side), side)
    return scene


def sphere(faces):
    """A globe of quads, with triangles around its poles, that touches the floor in one corner."""
    rows = max(3, round(math.sqrt(faces / 2)))
    scene = SceneText(digits=9)
    scene.group("globe", "red")
    theta = np.pi * np.arange(rows + 1) / rows
    phi = 2 * np.pi * np.arange(2 * rows) / (2 * rows)

    def point(i, j):
        s = 0.0 if i in (0, rows) else math.sin(theta[i])
        j %= 2 * rows
        return (s * math.cos(phi[j]), s * math.sin(phi[j]), 1 + math.cos(theta[i]))

    for i in range(rows):
        for j in range(2 * rows):
            corners = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
            if i == 0:
                corners = corners[:3]
            if i == rows - 1:
                corners = [corners[0], corners[1], corners[3]]
            scene.face(*corners)
    scene.group("floor")
    scene.face((-3, -3, 0), (3, -3, 0), (3, 3, 0), (-3, 3, 0))
    scene.lamp((0, 0, 4), 1)
    return scene


def add_furnished_room(scene, faces, origin):
    """A room of 4 x 4 x 3 with slabs on its floor, 1e-3 thick and 1e-3 apart."""
    x, y, z = origin
    scene.group("room")
    scene.box((x, y, z), (x + 4, y + 4, z + 3), inward=True)
    slabs = max(1, round((faces - 7) / 6))
    side = math.ceil(math.sqrt(slabs))
    scene.group("slabs", "red")
    for k in range(slabs):
        step = 3.0 / side
        a, b = x + 0.5 + step * (k % side), y + 0.5 + step * (k // side)
        scene.box((a, b, z), (a + step - 1e-3, b + step - 1e-3, z + 1e-3 * (1 + k % 3)))
    scene.lamp((x + 2, y + 2, z + 2.999), 1)


def million_units_away(faces):
    """A room whose corner is a million units from the origin on every axis, with details of 1e-3."""
    scene = SceneText(digits=12)
    add_furnished_room(scene, faces, (1e6, -1e6, 1e6))
    return scene


def two_million_units_apart(faces):
    """Two such rooms, two million units apart, as one forgotten object makes of any scene: every
    length that is a share of the diagonal is longer than a room's details."""
    scene = SceneText(digits=12)
    add_furnished_room(scene, faces / 2, (1e6, 0, 0))
    add_furnished_room(scene, faces / 2, (-1e6, 0, 0))
    return scene


FULL_SIZE = {
    cad_export: 100_000, doubled_house: 5_000, photogrammetry: 100_000, city: 20_000,
    linked_duplicates: 50_000, text_geometry: 10_000, leaf_cards: 50_000, terrain: 100_000,
    sphere: 1_000_000, million_units_away: 1_000, two_million_units_apart: 1_000}
