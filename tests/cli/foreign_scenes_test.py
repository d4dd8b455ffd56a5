"""Scenes for Mitsuba 3 and pbrt-v4: read back by their own rules, and checked by numbers from the scene."""

import math
import re
import struct
import unittest
import xml.etree.ElementTree as xml
import zlib

import numpy as np

from cli_runner import DATA, CliTest
from exr_file import ExrFile

EYE = "eye=.5,.5,.9;target=.5,.5,0;up=0,1,0;fov=60"
TO_SCENE = ["--camera", EYE, "--width", "200", "--height", "100"]


def numbers(text):
    return [float(word) for word in text.replace(",", " ").split()]


def serialized(path):
    """The meshes of a .serialized file: (vertices, uv or None, triangles) each."""
    data = path.read_bytes()
    count = struct.unpack("<I", data[-4:])[0]
    begins = struct.unpack(f"<{count}Q", data[-4 - 8 * count:-4])
    meshes = []
    for begin in begins:
        assert struct.unpack_from("<HH", data, begin) == (0x041C, 4)
        plain = zlib.decompressobj().decompress(data[begin + 4:])
        flags = struct.unpack_from("<I", plain)[0]
        assert flags & 0x2000, "double precision"
        at = plain.index(b"\0", 4) + 1
        vertices, triangles = struct.unpack_from("<QQ", plain, at)
        at += 16

        def take(rows, columns, kind):
            nonlocal at
            values = np.frombuffer(plain, kind, rows * columns, at).reshape(rows, columns)
            at += values.nbytes
            return values

        places = take(vertices, 3, "<f8")
        uv = take(vertices, 2, "<f8") if flags & 2 else None
        meshes.append((places, uv, take(triangles, 3, "<u4")))
        assert at == len(plain)
    return meshes


def vector_area(places, triangles):
    a, b, c = (places[triangles[:, k]] for k in range(3))
    return np.cross(b - a, c - a).sum(0) / 2


class Tokens:
    """The directives of a .pbrt file: (word, [strings], {"type name": [values]}, [numbers])."""

    def __init__(self, path):
        text = re.sub(r"#.*", "", path.read_text())
        tokens = re.findall(r'"[^"]*"|\[|\]|[^\s"\[\]]+', text)
        self.directives = []
        k = 0
        while k < len(tokens):
            word, strings, parameters, plain = tokens[k], [], {}, []
            k += 1
            while k < len(tokens) and not re.match("[A-Z]", tokens[k]):
                if tokens[k].startswith('"') and " " in tokens[k] and k + 1 < len(tokens) and tokens[k + 1] == "[":
                    end = tokens.index("]", k)
                    parameters[tokens[k][1:-1]] = [self.value(t) for t in tokens[k + 2:end]]
                    k = end + 1
                elif tokens[k].startswith('"'):
                    strings.append(tokens[k][1:-1])
                    k += 1
                else:
                    plain.append(float(tokens[k]))
                    k += 1
            self.directives.append((word, strings, parameters, plain))

    @staticmethod
    def value(token):
        return token[1:-1] if token.startswith('"') else token if token in ("true", "false") else float(token)

    def all(self, word, kind=None):
        return [(s, p, n) for w, s, p, n in self.directives if w == word and (kind is None or s[0] == kind)]

    def one(self, word, kind=None):
        found = self.all(word, kind)
        assert len(found) == 1, (word, kind, found)
        return found[0]


class ForeignScenes(CliTest):
    def both(self, scene, *more):
        """Writes both scenes; returns the tree of the one and the tokens of the other, and the run."""
        run = self.run_program("render", scene, *TO_SCENE, *more, "-o", "s.xml", "-o", "s.pbrt")
        return xml.parse(self.folder / "s.xml").getroot(), Tokens(self.folder / "s.pbrt"), run

    def test_a_box_goes_out_with_its_radiances_and_faces(self):
        mitsuba, pbrt, run = self.both("box.obj")
        self.assertEqual(self.files(), ["box.mtl", "box.obj", "s-mitsuba.serialized", "s.pbrt", "s.xml"])
        self.assertNotIn("form factors", run.out)
        # Ke of the .mtl is radiance, and so is that of both programs.
        lamps = mitsuba.findall("shape/emitter")
        self.assertEqual([numbers(lamp.find("rgb").get("value")) for lamp in lamps], [[5, 4, 3]])
        self.assertEqual([p["rgb L"] for _, p, _ in pbrt.all("AreaLightSource")], [[5, 4, 3]])
        colours = {bsdf.get("id").rsplit("_", 1)[0]: numbers(bsdf.find("rgb").get("value"))
                   for bsdf in mitsuba.findall("bsdf")}
        self.assertEqual(colours, {"lamp": [.2, .2, .2], "wall": [.5, .6, .7]})
        self.assertEqual({s[0].rsplit(" ", 1)[0]: p["rgb reflectance"] for s, p, _ in
                          pbrt.all("MakeNamedMaterial")}, colours)
        # A ceiling of 1 m^2 that faces down; five walls of the unit cube, which close it with that.
        meshes = serialized(self.folder / "s-mitsuba.serialized")
        shapes = mitsuba.findall("shape")
        self.assertEqual(len(shapes), len(meshes))
        for shape in shapes:
            places, _, triangles = meshes[int(shape.find("integer").get("value"))]
            expected = [0, -1, 0] if shape.find("emitter") is not None else [0, 1, 0]
            np.testing.assert_allclose(vector_area(places, triangles), expected, atol=1e-15)
        total = 0
        for (_, p, _), (places, _, triangles) in zip(pbrt.all("Shape"), meshes):
            np.testing.assert_array_equal(np.reshape(p["point3 P"], (-1, 3)), places)
            np.testing.assert_array_equal(np.reshape(p["integer indices"], (-1, 3)), triangles)
            total += len(triangles)
        self.assertEqual(total, 12)
        self.assertIn("pbrt: backs reflect", run.err + run.out)

    def test_materials_of_two_sides(self):
        mitsuba, pbrt, run = self.both("box.obj", "--two-sided", "all")
        self.assertEqual([b.get("type") for b in mitsuba.findall("bsdf")], ["twosided", "twosided"])
        self.assertEqual(pbrt.one("AreaLightSource")[1]["bool twosided"], ["true"])
        self.assertNotIn("pbrt: backs", run.err + run.out)
        self.assertIn("emits from its front alone", run.err + run.out)

    def test_the_camera_sees_the_same(self):
        """Where a place lies in the picture: by each format's own rules, and by those of a pinhole."""
        mitsuba, pbrt, _ = self.both("box.obj")
        place = np.array([.7, .6, 0])
        tangent = math.tan(math.radians(30))
        right, up = .2 / (.9 * tangent), .1 / (.9 * tangent)  # of half the height
        look = mitsuba.find("sensor/transform/lookat")
        origin, target, high = (np.array(numbers(look.get(k))) for k in ("origin", "target", "up"))
        self.assertEqual(mitsuba.find("sensor/string").get("value"), "y")
        self.assertAlmostEqual(float(mitsuba.find("sensor/float").get("value")), 60)
        ahead = target - origin
        ahead /= np.linalg.norm(ahead)
        left = np.cross(high, ahead)  # Mitsuba's x points to the left of the picture
        seen = place - origin
        np.testing.assert_allclose([-seen @ left / (seen @ ahead) / tangent, seen @ high / (seen @ ahead) / tangent],
                                   [right, up])
        self.assertEqual(pbrt.one("Scale")[2], [-1, 1, 1])
        eye, to, high = np.reshape(pbrt.one("LookAt")[2], (3, 3))
        ahead = (to - eye) / np.linalg.norm(to - eye)
        x = np.cross(high, ahead)  # to the right of the picture, in pbrt, but for the mirror
        seen = place - eye
        fov = math.tan(math.radians(pbrt.one("Camera")[1]["float fov"][0] / 2))
        np.testing.assert_allclose([-seen @ x / (seen @ ahead) / fov, seen @ high / (seen @ ahead) / fov],
                                   [right, up])
        film = pbrt.one("Film")[1]
        self.assertEqual((film["integer xresolution"], film["integer yresolution"]), ([200], [100]))

    def test_the_angle_of_pbrt_is_of_the_shorter_side(self):
        self.run_program("render", "box.obj", "--camera", EYE, "--width", "50", "--height", "100", "-o", "s.pbrt")
        fov = Tokens(self.folder / "s.pbrt").one("Camera")[1]["float fov"][0]
        self.assertAlmostEqual(math.tan(math.radians(fov / 2)), math.tan(math.radians(30)) / 2)

    def test_lights_without_a_surface(self):
        lights = ["--light", "point,12W/sr,at=1,2,3,range=9,name=near", "--light",
                  "spot,6W/sr,at=0,2,0,aim=0,0,0,inner=10,outer=20", "--sun", "800,toward=0,1,1", "--sky", "1,2,3"]
        mitsuba, pbrt, run = self.both("box.obj", *lights)
        emitters = {e.get("type"): e for e in mitsuba.findall("emitter")}
        self.assertEqual(set(emitters), {"point", "spot", "directional", "constant"})
        values = {kind: numbers(e.find("rgb").get("value")) for kind, e in emitters.items()}
        self.assertEqual(values, {"point": [12] * 3, "spot": [6] * 3, "directional": [800] * 3, "constant": [1, 2, 3]})
        self.assertEqual(numbers(emitters["point"].find("point").get("value")), [1, 2, 3])
        np.testing.assert_allclose(numbers(emitters["directional"].find("vector").get("value")),
                                   [0, -math.sqrt(.5), -math.sqrt(.5)])
        self.assertEqual([float(f.get("value")) for f in emitters["spot"].findall("float")], [20, 10])
        self.assertEqual(pbrt.one("LightSource", "point")[1],
                         {"rgb I": [12] * 3, "point3 from": [1, 2, 3]})
        self.assertEqual(pbrt.one("LightSource", "spot")[1],
                         {"rgb I": [6] * 3, "point3 from": [0, 2, 0], "point3 to": [0, 0, 0], "float coneangle": [20],
                          "float conedeltaangle": [10]})
        distant = pbrt.one("LightSource", "distant")[1]
        self.assertEqual(distant["rgb L"], [800] * 3)
        np.testing.assert_allclose(distant["point3 from"], [0, math.sqrt(.5), math.sqrt(.5)])
        self.assertEqual(pbrt.one("LightSource", "infinite")[1], {"rgb L": [1, 2, 3]})
        said = run.err + run.out
        for words in ("'near' shines without end, here 9 m far", "'spot' falls off", "'sun' has sharp shadows"):
            self.assertEqual(said.count(words), 2, said)

    def test_a_lamp_of_a_file_is_left_out_by_name(self):
        mitsuba, pbrt, run = self.both("box.obj", "--light", f"ies,{DATA / 'panel.ldt'},at=.5,.9,.5,name=panel")
        self.assertEqual(mitsuba.findall("emitter"), [])
        self.assertEqual(pbrt.all("LightSource"), [])
        self.assertEqual((run.err + run.out).count("'panel' is left out"), 2)

    def test_skies_become_images_by_each_program_s_axes(self):
        """What open ground gets from the image is what the sky was said to give it."""
        mitsuba, pbrt, _ = self.both("box.obj", "--cie-sky", "100,type=12,toward=0,1,1")
        name = mitsuba.find("emitter[@type='envmap']/string").get("value")
        sky = ExrFile(self.folder / name).channels["G"].astype(float)
        rows, columns = sky.shape
        down = math.pi * np.arange(rows) / (rows - 1)
        turn = 2 * math.pi * (np.arange(columns) + .5) / columns
        lit = np.cos(down).clip(0)[:, None] * np.sin(down)[:, None] * sky
        # A step of .35 degrees beside a horizon that ends at once: a quarter per cent.
        self.assertAlmostEqual(lit.sum() * math.pi / (rows - 1) * 2 * math.pi / columns, 100, delta=.25)
        # The brightest place is around the sun, at y = z: halfway down, in the middle column.
        brightest = np.unravel_index(sky.argmax(), sky.shape)
        self.assertAlmostEqual(down[brightest[0]], math.pi / 4, delta=.01)
        self.assertAlmostEqual(turn[brightest[1]], math.pi, delta=.01)
        square = ExrFile(self.folder / pbrt.one("LightSource", "infinite")[1]["string filename"][0])
        sky = square.channels["G"].astype(float)
        side = square.width
        t, s = np.meshgrid(*[(2 * np.arange(side) + 1) / side - 1] * 2, indexing="ij")
        # Rows are y there, 0 in the middle; all pixels have one solid angle.
        brightest = np.unravel_index(sky.argmax(), sky.shape)
        self.assertEqual(sky[t < -.01].max(), 0)  # y < 0: below the horizon
        self.assertAlmostEqual(s[brightest], 0, delta=.01)
        # Of z = 1 - r^2 with r = |t| on the middle column.
        self.assertAlmostEqual(1 - t[brightest] ** 2, math.sqrt(.5), delta=.01)
        r = 1 - abs(1 - abs(s) - abs(t))
        with np.errstate(invalid="ignore"):
            phi = np.where(r > 0, (abs(t) - abs(s)) / r + 1, 1) * math.pi / 4
        y = np.sign(t) * np.sin(phi) * r * np.sqrt(2 - r * r)
        self.assertAlmostEqual((sky * y.clip(0)).sum() * 4 * math.pi / side ** 2, 100, delta=.25)

    def test_textures_go_along(self):
        """Texels times the factor, and coordinates that grow downwards in Mitsuba and upwards in pbrt."""
        self.write("checker.obj", "mtllib checker.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                  "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 .75\no wall\nusemtl paint\nf 1/1 2/2 3/3 4/4\n")
        self.write("checker.mtl", "newmtl paint\nKd .5 .5 .5\nmap_Kd two.ppm\n")
        (self.folder / "two.ppm").write_bytes(b"P6 1 2 255\n" + bytes([255, 255, 255, 0, 0, 0]))
        mitsuba, pbrt, _ = self.both("checker.obj")
        texture = mitsuba.find("bsdf/texture")
        self.assertEqual(texture.find("boolean").get("value"), "true")
        for name in (texture.find("string[@name='filename']").get("value"),
                     pbrt.one("Texture")[1]["string filename"][0]):
            np.testing.assert_allclose(ExrFile(self.folder / name).channels["R"], [[.5], [0]], atol=1e-7)
        places, uv, _ = serialized(self.folder / "s-mitsuba.serialized")[0]
        corner = {tuple(p[:2]): list(t) for p, t in zip(places, uv)}
        self.assertEqual(corner, {(0, 0): [0, 1], (1, 0): [1, 1], (1, 1): [1, 0], (0, 1): [0, .25]})
        shape = pbrt.one("Shape")[1]
        upward = {tuple(p[:2]): list(t) for p, t in zip(np.reshape(shape["point3 P"], (-1, 3)),
                                                       np.reshape(shape["point2 uv"], (-1, 2)))}
        self.assertEqual(upward, {(0, 0): [0, 0], (1, 0): [1, 0], (1, 1): [1, 1], (0, 1): [0, .75]})

    def test_names_are_quoted(self):
        self.write("odd.obj", 'o a"<&>b\n' + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        mitsuba, pbrt, _ = self.both("odd.obj")
        self.assertEqual(len(mitsuba.findall("shape")), 1)
        self.assertEqual(len(pbrt.all("Shape")), 1)

    def test_beside_a_picture_they_have_its_camera(self):
        self.run_program("render", "box.obj", "--patches", "60", "-o", "p.exr", "-o", "p.pbrt")
        eye = re.search(r"eye=([^;]*);", ExrFile(self.folder / "p.exr").texts["camera"])[1]
        np.testing.assert_allclose(Tokens(self.folder / "p.pbrt").one("LookAt")[2][:3], numbers(eye), rtol=1e-5)

    def test_what_cannot_be_is_refused(self):
        self.refuse("render", "box.obj", *TO_SCENE, "--show", "illuminance", "-o", "s.xml", "-o", "a.png",
                    words=["s.xml", "--show"])
        self.refuse("solve", "box.obj", "-o", "s.xml", words=["s.xml: solve writes"])
        self.refuse("render", "box.obj", *TO_SCENE, "-o", "nowhere/s.xml", words=["nowhere"])


if __name__ == "__main__":
    unittest.main()
