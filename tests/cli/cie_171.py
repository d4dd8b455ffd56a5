"""Test cases of CIE 171:2006, "Test cases to assess the accuracy of lighting computer programs", with closed forms:
rooms of their own, points, and what these get."""

import math
from typing import NamedTuple

LUMENS = 683  # a watt


class Case(NamedTuple):
    number: str
    what: str
    files: dict  # of the scene, room.obj, by name
    points: list  # x, y, z, and the way that each faces; y is up
    truth: list  # lux
    given: list  # the same as published, in the digits that they have
    cycles: float  # the largest error that Blender's Cycles has, percent


def room(width, depth, height, panel=0.0):
    """An .obj of a closed room, y up, middle of the floor at the origin; a panel in its ceiling."""
    w, d, a = width / 2, depth / 2, panel / 2
    corners = [(x, y, z) for y in (0, height) for x, z in ((-w, -d), (w, -d), (w, d), (-w, d))]
    corners += [(x, height, z) for x, z in ((-a, -a), (a, -a), (a, a), (-a, a))]
    faces = {"floor": "1 4 3 2", "ceiling": "5 6 7 8", "left": "1 5 8 4", "right": "2 3 7 6",
             "back": "1 2 6 5", "front": "4 8 7 3"}
    text = "mtllib room.mtl\n" + "".join("v %.17g %.17g %.17g\n" % p for p in corners)
    text += "".join(f"o {name}\nusemtl wall\nf {face}\n" for name, face in faces.items())
    return text + ("o panel\nusemtl lamp\nf 9 10 11 12\n" if panel else "")


def materials(reflectance, radiance=0.0):
    return (f"newmtl wall\nKd {reflectance} {reflectance} {reflectance}\n"
            f"newmtl lamp\nKd 0 0 0\nKe {radiance} {radiance} {radiance}\n")


def black_room(panel, luminance):
    return {"room.obj": room(4, 4, 3, panel), "room.mtl": materials(0, luminance / LUMENS)}


def shining(surface):
    """A room of black walls, one of which gives 100 lm/m^2."""
    return {"room.obj": room(4, 4, 3).replace(f"o {surface}\nusemtl wall", f"o {surface}\nusemtl lamp"),
            "room.mtl": materials(0, 100 / math.pi / LUMENS)}


def _corners(factor, x0, x1, y0, y1):
    """Over a rectangle, of a factor to the one from the origin to (x, y)."""
    def signed(x, y):
        return math.copysign(1, x) * math.copysign(1, y) * factor(abs(x), abs(y))
    return signed(x1, y1) - signed(x0, y1) - signed(x1, y0) + signed(x0, y0)


def opposite(x0, x1, y0, y1, distance):
    """The configuration factor from a point to a rectangle that it faces (Howell, B-3)."""
    def factor(x, y):
        a, b = x / distance, y / distance
        return (a / math.hypot(1, a) * math.atan(b / math.hypot(1, a)) +
                b / math.hypot(1, b) * math.atan(a / math.hypot(1, b))) / (2 * math.pi)
    return _corners(factor, x0, x1, y0, y1)


def beside(x0, x1, near, far, distance):
    """The same to a rectangle in a plane that is upright to its own, at that distance, from `near` to `far` in the
    direction that it faces (Howell, B-4)."""
    def factor(x, y):
        return (math.atan(x / distance) -
                distance / math.hypot(distance, y) * math.atan(x / math.hypot(distance, y))) / (2 * math.pi)
    return _corners(factor, x0, x1, near, far)


def cosine_point():
    places = [(0, 0), (.5, 0), (1, 0), (1.5, 0), (.5, .5), (1, .5), (1.5, .5), (1, 1), (1.5, 1), (1.5, 1.5)]
    # A panel of 1 cm is a point to (size / distance)^2 = 1e-5.
    return Case("5.2", "a point, 1000 cd times the cosine, 3 m over a floor", black_room(.01, 1000 / 1e-4),
                [(x, 0, z, 0, 1, 0) for x, z in places], [1000 * 9 / (9 + x * x + z * z) ** 2 for x, z in places],
                [111.11, 105.19, 90.00, 71.11, 99.72, 85.66, 68.05, 74.38, 59.98, 49.38], .99)


def panel_in_the_ceiling():
    heights, off = (2.75, 2.25, 1.75, 1.25, .75, .25), (.25, .75, 1.25, 1.75)
    truth = [1000 * math.pi * beside(-.5, .5, 1.5, 2.5, 3 - y) for y in heights]
    truth += [1000 * math.pi * opposite(x - .5, x + .5, -.5, .5, 3) for x in off]
    return Case("5.3", "a square metre in the ceiling, 1000 cd", black_room(1, 1000),
                [(2, y, 0, -1, 0, 0) for y in heights] + [(x, 0, 0, 0, 1, 0) for x in off], truth,
                [32.68, 75.19, 81.32, 69.06, 53.40, 40.00, 105.78, 95.67, 79.26, 61.42], 4.94)


def floor_that_shines():
    heights, off = (.75, 1.25, 1.75, 2.25, 2.75), (.25, .75, 1.25, 1.75)
    truth = [100 * beside(-2, 2, 0, 4, y) for y in heights]
    truth += [100 * opposite(-x, 4 - x, -2, 2, 3) for x in off]
    return Case("5.6", "a floor that shines", shining("floor"),
                [(2, y, 0, -1, 0, 0) for y in heights] + [(x - 2, 3, 0, 0, -1, 0) for x in off], truth,
                [35.901, 27.992, 21.639, 16.716, 12.967, 26.80, 30.94, 33.98, 35.57], .25)


def wall_behind_a_box():
    """A wall that shines, and before it a black box as wide as the room, 1 m high, 2.5 to 2.7 m from the wall
    opposite, whose middle line and that of the floor are measured. What is seen of the wall is above the higher of
    the shadows that the box's two upper edges throw."""
    files = shining("front")
    box = [(x, y, z) for y in (0, 1) for x, z in ((-2, .5), (2, .5), (2, .7), (-2, .7))]
    files["room.obj"] += "".join("v %g %g %g\n" % corner for corner in box)
    first = 9 + 4  # after the corners of the room and of a panel that it has not
    faces = [(4, 5, 6, 7)[::-1], (0, 4, 5, 1), (2, 6, 7, 3)]
    files["room.obj"] += "o box\nusemtl wall\n" + "".join(
        "f " + " ".join(str(first + corner) for corner in face) + "\n" for face in faces)
    heights, off = (2.75, 2.25, 1.75, 1.25, .75, .25), (.25, .75, 1.25, 1.75, 2.25)
    truth = []
    for y in heights:
        shadow = max(0, *(y + (1 - y) * 4 / edge for edge in (2.5, 2.7)))
        truth.append(100 * opposite(-2, 2, shadow - y, 3 - y, 4))
    for z in off:
        shadow = max((4 - z) / (edge - z) for edge in (2.5, 2.7))
        truth.append(100 * beside(-2, 2, min(shadow, 3), 3, 4 - z))
    return Case("5.7", "a wall that shines, behind a box", files,
                [(0, y, -2, 0, 0, 1) for y in heights] + [(0, 0, z - 2, 0, 1, 0) for z in off], truth,
                [16.07, 16.33, 15.40, 13.32, 10.32, 7.08, 3.38, 3.63, 3.01, 0, 0], 1.07)


def cases():
    return [cosine_point(), panel_in_the_ceiling(), floor_that_shines(), wall_behind_a_box()]


REFLECTANCES = (.05, .1, .2, .3, .4, .5, .6, .7, .8, .9, .95)
#: Of 5.8, a cube of 4 m with an isotropic lamp of 10,000 lm in its middle: what Cycles is off by, percent.
CYCLES_BETWEEN_WALLS = .31


def between_walls(reflectance):
    """The files of case 5.8, what goes to the program beside room.obj, and the mean of indirect light on walls."""
    grids = [word for wall in ("floor", "ceiling", "left", "back") for word in ("--grid", f"{wall}:0:.125")]
    return ({"room.obj": room(4, 4, 4), "room.mtl": materials(reflectance)},
            ["--light", "point,10000lm,at=0,2,0", *grids], 10000 * reflectance / (96 * (1 - reflectance)))


def indirect_means(report):
    """The means of indirect light of the grids of a report of `illuminance`."""
    return [part["indirect_mean_lx"] for name, part in report.items() if name.startswith("illuminance")]
