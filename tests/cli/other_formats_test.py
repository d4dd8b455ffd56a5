"""OFF, and what Assimp reads: Collada, FBX, 3DS and DXF, with their names, colours and units."""

import math
import os
import pathlib
import shutil
import socket
import struct
import subprocess
import sys
import unittest

import h5py
import numpy as np
from PIL import Image

from cli_runner import PROGRAM, CliTest, limit

# A face of one metre above the plane x, y; what follows a number is a group code's value.
DXF = "\n".join(["0", "SECTION", "2", "ENTITIES", "0", "3DFACE", "8", "roof"] +
                [word for k, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)])
                 for word in (f"1{k}", str(x), f"2{k}", str(y), f"3{k}", "2")] + ["0", "ENDSEC", "0", "EOF", ""])


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]

COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_effects>
<effect id="paint-fx"><profile_COMMON><technique sid="common"><lambert>
<emission><color>2 1 0 1</color></emission><diffuse><color>0.25 0.5 0.75 1</color></diffuse>
</lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint" name="paint"><instance_effect url="#paint-fx"/></material></library_materials>
<library_geometries><geometry id="plate" name="plate"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 100 100 0 0 100 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist material="m" count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="wall" name="north wall"><scale>2 1 1</scale>
<instance_geometry url="#plate"><bind_material><technique_common>
<instance_material symbol="m" target="#paint"/></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
"""

# The same plate with an image of a red and a blue half, and a camera that looks at it from above.
TEXTURED = (COLLADA
    .replace("<library_effects>", """<library_images><image id="im" name="im"><init_from>C:\\work\\HALVES.PNG</init_from>
</image></library_images><library_cameras><camera id="c" name="c"><optics><technique_common><perspective>
<xfov>60</xfov><aspect_ratio>2</aspect_ratio></perspective></technique_common></optics></camera></library_cameras>
<library_effects>""")
    .replace("<technique sid=", """<newparam sid="su"><surface type="2D"><init_from>im</init_from></surface></newparam>
<newparam sid="sa"><sampler2D><source>su</source></sampler2D></newparam><technique sid=""")
    .replace("<color>0.25 0.5 0.75 1</color>", '<texture texture="sa" texcoord="UV0"/>')
    .replace("<vertices id=", """<source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array>
<technique_common><accessor source="#ta" count="4" stride="2"><param name="S" type="float"/>
<param name="T" type="float"/></accessor></technique_common></source><vertices id=""")
    .replace("""source="#v" offset="0"/>""", """source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="0" set="0"/>""")
    .replace("""target="#paint"/>""", """target="#paint"><bind_vertex_input semantic="UV0" input_semantic="TEXCOORD"
input_set="0"/></instance_material>""").replace("</instance_material></instance_material>", "</instance_material>")
    .replace("</visual_scene>", """<node id="cam" name="above"><translate>50 50 300</translate>
<instance_camera url="#c"/></node></visual_scene>"""))

FBX = """; FBX 7.3.0 project file
FBXHeaderExtension:  {
    FBXVersion: 7300
}
GlobalSettings:  {
    Version: 1000
    Properties70:  {
        P: "UnitScaleFactor", "double", "Number", "",1
    }
}
Objects:  {
    Geometry: 1, "Geometry::plate", "Mesh" {
        Vertices: *12 {
            a: 0,0,0,100,0,0,100,100,0,0,100,0
        }
        PolygonVertexIndex: *4 {
            a: 0,1,2,-4
        }
    }
    Model: 2, "Model::wall", "Mesh" {
        Version: 232
    }
}
Connections:  {
    C: "OO",2,0
    C: "OO",1,2
}
"""


def with_lights(*kinds):
    """The plate and a light of each kind (0 point, 1 sun, 2 spot): 2 m up, pointing along -y, but for a turn of the spot
    that makes it point along -z."""
    objects = links = ""
    for k, kind in enumerate(kinds):
        a, m = 100 + 2 * k, 101 + 2 * k
        turn = '            P: "Lcl Rotation", "Lcl Rotation", "", "A",90,0,0\n' if kind == 2 else ""
        objects += f"""    NodeAttribute: {a}, "NodeAttribute::lamp{k}", "Light" {{
        Properties70:  {{
            P: "LightType", "enum", "", "",{kind}
            P: "Color", "Color", "", "A",1,0.5,0.25
            P: "Intensity", "Number", "", "A",2000
            P: "InnerAngle", "Number", "", "A",40
            P: "OuterAngle", "Number", "", "A",60
        }}
    }}
    Model: {m}, "Model::lamp{k}", "Light" {{
        Version: 232
        Properties70:  {{
            P: "Lcl Translation", "Lcl Translation", "", "A",50,50,200
{turn}        }}
    }}
"""
        links += f'    C: "OO",{m},0\n    C: "OO",{a},{m}\n'
    text = FBX.replace('    Geometry: 1,', objects + '    Geometry: 1,')
    return text.replace('    C: "OO",2,0\n', links + '    C: "OO",2,0\n')


COLLADA_LIGHTS = (COLLADA
    .replace("<library_effects>", """<library_lights>
<light id="p"><technique_common><point><color>8 4 2</color></point></technique_common></light>
<light id="d"><technique_common><directional><color>3 2 1</color></directional></technique_common></light>
<light id="s"><technique_common><spot><color>3 2 1</color></spot></technique_common></light>
<light id="a"><technique_common><ambient><color>3 2 1</color></ambient></technique_common></light>
</library_lights><library_effects>""")
    .replace("</visual_scene>", """<node id="n1" name="bulb"><translate>50 50 300</translate>
<instance_light url="#p"/></node><node id="n2" name="day"><rotate>1 0 0 -90</rotate><instance_light url="#d"/></node>
<node id="n3" name="beam"><instance_light url="#s"/></node>
<node id="n4" name="all"><instance_light url="#a"/></node></visual_scene>"""))


def chunk(number, body):
    return struct.pack("<HI", number, 6 + len(body)) + body


def three_ds(lights=b"", nodes=b""):
    """A square wall; `lights` beside it, and their `nodes` in the animation."""
    colour = chunk(0x0010, struct.pack("<3f", .25, .5, .75))
    material = chunk(0xAFFF, chunk(0xA000, b"paint\0") + chunk(0xA020, colour))
    mesh = chunk(0x4110, struct.pack("<H12f", 4, *(x for p in SQUARE for x in p)))
    faces = struct.pack("<H8H", 2, 0, 1, 2, 0, 0, 2, 3, 0)
    mesh += chunk(0x4120, faces + chunk(0x4130, b"paint\0" + struct.pack("<3H", 2, 0, 1)))
    scene = chunk(0x3D3D, material + chunk(0x4000, b"wall\0" + chunk(0x4100, mesh)) + lights)
    node = chunk(0xB002, chunk(0xB010, b"wall\0" + struct.pack("<HHh", 0, 0, -1)))
    return chunk(0x4D4D, scene + chunk(0xB000, node + nodes))


OFF = "OFF # a comment\n4 2 0\n0 0 0\n1 0 0 # two\n1 1 0\n\n0 1 0\n3 0 1 2 0.5 0.5 0.5\n3 0 2 3\n"


class OtherFormats(CliTest):
    def put(self, name, content):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def only_surface(self, name, content, *options):
        scene = self.report("info", self.put(name, content), *options)["scene"]
        self.assertEqual(len(scene["surfaces"]), 1)
        surface = scene["surfaces"][0]
        material = next(m for m in scene["materials"] if m["name"] == surface["material"])
        return surface, material

    def says(self, line, name, content):
        self.assertEqual(self.refuse("info", self.put(name, content)), f"radiosity: {name}{line}")

    def test_collada(self):
        surface, material = self.only_surface("a.dae", COLLADA)
        self.assertEqual([surface["name"], surface["faces"]], ["north wall/paint", 1])
        # Single precision, and centimetres; the node is twice as wide.
        self.assertAlmostEqual(surface["area_m2"], 2, 6)
        self.assertEqual([material["reflectance"], material["radiance_W_per_m2_sr"]], ["0.25, 0.5, 0.75", "2, 1, 0"])

    def patches_of(self, *options):
        """Centroid and reflectance of each front patch of the textured plate."""
        self.run_program("solve", "a.dae", "--patches", "8", *options, "-o", "r.h5")
        with h5py.File(self.folder / "r.h5") as results:
            return results["form_factors/centroid"][()], results["solution/reflectance"][()]

    def test_textures_are_found_by_name_and_stand_in_place_of_colours(self):
        halves = np.zeros((2, 4, 3), np.uint8)
        halves[:, :2] = (255, 0, 0)
        halves[:, 2:] = (0, 0, 255)
        halves[0] //= 5  # the upper row is 51 / 255, which is .0331 linear
        Image.fromarray(halves).save(self.folder / "halves.png")
        self.put("a.dae", TEXTURED)
        run = self.run_program("info", "a.dae")
        self.assertIn("taken from beside the scene: texture: C:\\work\\HALVES.PNG", run.out)
        centroid, reflectance = self.patches_of()
        dark = ((51 / 255 + 0.055) / 1.055) ** 2.4  # sRGB, IEC 61966-2-1
        for at, rho in zip(centroid, reflectance):
            value = dark if at[1] > 0.5 else 1
            expected = [value, 0, 0] if at[0] < 1 else [0, 0, value]
            np.testing.assert_allclose(rho, expected, atol=1e-6)  # texels are floats
        _, off = self.patches_of("--textures", "off")
        os.remove(self.folder / "halves.png")
        run = self.run_program("info", "a.dae")
        self.assertIn("are not there; the colour alone counts, material: paint (C:\\work\\HALVES.PNG)", run.err)
        _, without = self.patches_of()
        np.testing.assert_array_equal(off, 1)  # Assimp's colour beside a texture, as asked for
        np.testing.assert_array_equal(without, 0.5)

    def test_cameras_of_collada(self):
        self.put("a.dae", TEXTURED)
        camera = self.report("info", "a.dae")["scene"]["cameras"][0]
        self.assertEqual(camera["name"], "above")
        np.testing.assert_allclose(np.array(camera["eye_m"].split(", "), float), [.5, .5, 3], rtol=1e-6)
        np.testing.assert_allclose(np.array(camera["target_m"].split(", "), float), [.5, .5, 2], rtol=1e-6)
        # 60 degrees wide, half as high.
        self.assertAlmostEqual(float(camera["fov_deg"]), math.degrees(2 * math.atan(math.tan(math.pi / 6) / 2)), 3)

    def test_angles_of_collada_cameras_in_every_combination(self):
        angles = "<xfov>60</xfov><aspect_ratio>2</aspect_ratio>"
        half = math.tan(math.pi / 6)  # of 60 degrees
        for given, vertical in [
                ("<yfov>45</yfov>", 45),
                ("<yfov>45</yfov><aspect_ratio>2</aspect_ratio>", 45),
                ("<xfov>60</xfov><yfov>45</yfov>", 45),
                ("<xfov>60</xfov>", math.degrees(2 * math.atan(half * 3 / 4))),  # taken for 4 : 3
        ]:
            with self.subTest(given=given):
                self.put("a.dae", TEXTURED.replace(angles, given))
                camera = self.report("info", "a.dae")["scene"]["cameras"][0]
                self.assertAlmostEqual(float(camera["fov_deg"]), vertical, 3)
        self.put("a.dae", TEXTURED.replace(angles, ""))
        run = self.run_program("info", "a.dae")
        self.assertIn("cameras without a view direction or an angle are not used: above", run.err)
        self.put("a.dae", TEXTURED.replace("perspective>", "orthographic>"))
        self.assertIn("cameras without perspective are not used: c", self.run_program("info", "a.dae").err)

    def test_collada_nodes_without_names_go_by_their_ids(self):
        content = TEXTURED.replace(' name="north wall"', "").replace(' name="above"', "")
        self.put("a.dae", content)
        scene = self.report("info", "a.dae")["scene"]
        self.assertEqual(scene["surfaces"][0]["name"], "wall/paint")
        self.assertEqual(scene["cameras"][0]["name"], "cam")

    def test_collada_of_cameras_alone_has_no_faces(self):
        geometry = TEXTURED[TEXTURED.index("<instance_geometry"):TEXTURED.index("</instance_geometry>")]
        self.says(": no faces; export the scene with its meshes as polygons", "a.dae",
                  TEXTURED.replace(geometry + "</instance_geometry>", ""))

    def test_3ds(self):
        surface, material = self.only_surface("a.3ds", three_ds())
        self.assertEqual([surface["name"], surface["faces"], surface["area_m2"]], ["wall/paint", 2, 1])
        self.assertEqual(material["reflectance"], "0.25, 0.5, 0.75")
        self.says(f": is cut off: it says that it has {len(three_ds())} bytes and has {len(three_ds()) - 9}; export "
                  "it again", "a.3ds", three_ds()[:-9])
        self.says(": is no 3DS file; export it again", "a.3ds", "hello world")

    def test_dxf_is_read(self):
        """Up is z in drawings."""
        surface, _ = self.only_surface("a.dxf", DXF)
        self.assertEqual([surface["faces"], surface["area_m2"]], [1, 1])
        self.assertIn("roof", surface["name"])

    def test_fbx_is_read(self):
        surface, material = self.only_surface("a.fbx", FBX, "--default-reflectance", ".3")
        self.assertEqual([surface["name"], surface["area_m2"]], ["wall", 1])
        self.assertEqual(material["reflectance"], "0.3, 0.3, 0.3")

    def lights_of(self, name, content):
        run = self.run_program("info", self.put(name, content))
        return run, {light["name"]: light for light in self.report("info", name)["scene"]["lights"]}

    def assert_up(self, sun):
        toward = np.array(sun["stands"].removeprefix("towards ").split(", "), float)
        np.testing.assert_allclose(toward, [0, 1, 0], atol=1e-6)  # floats

    def test_lights_of_fbx(self):
        """Watts, as Blender writes them: 20 W in all directions are 20 / (4 pi) W/sr. Centimetres are metres."""
        run, lights = self.lights_of("a.fbx", with_lights(0, 1, 2))
        watts = [20 / (4 * math.pi) * share for share in (1, .5, .25)]
        for name, kind in [("lamp0", "point"), ("lamp2", "spot")]:
            light = lights[name]
            self.assertEqual(light["kind"], kind)
            np.testing.assert_allclose(np.array(light["strength"].removesuffix(" W/sr").split(", "), float), watts,
                                       rtol=1e-5)  # six digits
            self.assertIn("0.5, 0.5, 2", light["stands"])
        self.assertEqual(lights["lamp1"]["strength"], "20, 10, 5 W/m^2")
        self.assert_up(lights["lamp1"])
        self.assertIn("lamps have no unit in this format", run.err)
        # The spot lights the middle of the plate, 2 m off: P / (4 pi) / d^2. Its cones are 40 and 60 degrees wide.
        for at, share in [((.5, .5, 0), 1), ((.5, .5 + 2 * math.tan(math.radians(19)), 0), math.cos(math.radians(19)) ** 3),
                          ((.5, .5 + 2 * math.tan(math.radians(31)), 0), 0)]:
            self.write("p.csv", "x,y,z,nx,ny,nz\n" + ",".join(map(str, at)) + ",0,0,1\n")
            self.run_program("illuminance", "a.fbx", "--without", "lamp0", "--without", "lamp1", "--set",
                             "all.reflectance=0", "--points", "p.csv", "-o", "o.csv")
            found = np.genfromtxt(self.folder / "o.csv", delimiter=",", names=True)["illuminance_lx"]
            expected = 683 * np.dot(watts, (.2126, .7152, .0722)) / 4 * share
            np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-9)  # points stand 1e-5 m off

    def test_lights_of_3ds(self):
        """With a node in the animation, and without; 4 W of red, a half of green, a quarter of blue over 4 pi."""
        colour = chunk(0x0010, struct.pack("<3f", 1, .5, .25)) + chunk(0x465B, struct.pack("<f", 4))
        bulb = chunk(0x4000, b"bulb\0" + chunk(0x4600, struct.pack("<3f", .5, .5, 2) + colour))
        node = chunk(0xB005, chunk(0xB010, b"bulb\0" + struct.pack("<HHh", 0, 0, -1)))
        for nodes in node, b"":
            with self.subTest(nodes=len(nodes)):
                _, lights = self.lights_of("a.3ds", three_ds(bulb, nodes))
                self.assertEqual(set(lights) - {"sky"}, {"bulb"})
                self.assertEqual(lights["bulb"]["strength"], "0.31831, 0.159155, 0.0795775 W/sr")
                self.assertEqual(lights["bulb"]["stands"], "at 0.5, 2, -0.5")  # z is up in the file

    def test_lights_of_collada(self):
        run, lights = self.lights_of("a.dae", COLLADA_LIGHTS)
        self.assertEqual(set(lights) - {"sky"}, {"bulb", "day"})
        np.testing.assert_allclose(np.array(lights["bulb"]["strength"].removesuffix(" W/sr").split(", "), float),
                                   np.array([8, 4, 2]) / (4 * math.pi), rtol=1e-5)
        self.assertIn("0.5, 0.5, 3", lights["bulb"]["stands"])
        self.assertEqual(lights["day"]["strength"], "3, 2, 1 W/m^2")
        self.assert_up(lights["day"])
        self.assertIn("spots are read of FBX alone, and left out: beam", run.err)
        self.assertIn("ambient light is left out", run.err)
        self.says(f": bulb intensity {-8 / (4 * math.pi)} is not a finite value of 0 or more; correct the light",
                  "a.dae", COLLADA_LIGHTS.replace("<color>8 4 2", "<color>-8 4 2"))

    def test_off_is_read(self):
        surface, _ = self.only_surface("a.off", OFF)
        self.assertEqual([surface["name"], surface["faces"], surface["area_m2"]], ["a", 2, 1])
        for old, new, line in [
                ("OFF", "OFFF", ":1: is no OFF file in text, which begins with OFF, COFF or NOFF; export it again"),
                ("4 2 0", "400000000 2 0", ":2: vertices 400000000: the file is too short for so many; it is cut off or "
                                           "damaged, export it again"),
                ("4 2 0", "-4 2 0", ":2: vertices `-4` is not a whole number of 0 or more; correct it"),
                ("1 1 0", "1 nan 0", ":5: coordinate `nan` is not a finite number; write it as 1.5 with a decimal point"),
                ("1 1 0", "1 1", ":5: a vertex has 3 coordinates; correct the line"),
                ("3 0 2 3", "3 0 2 4", ":9: vertex 4 does not exist, there are 4 (from 0); correct the face"),
                ("3 0 2 3", "4 0 2 3", ":9: a face has 3 corners or more, each a number; correct or remove it"),
                ("3 0 2 3\n", "", ":9: the file ends too early; export it again"),
        ]:
            with self.subTest(new=new):
                self.says(line, "a.off", OFF.replace(old, new))
        self.says(": is a cloud of 4 points without faces; make a surface of it first (in MeshLab: Filters, "
                  "Remeshing, Surface Reconstruction)", "a.off", OFF[:OFF.index("3 0 1 2")].replace("4 2 0", "4 0 0"))

    def test_formats_for_converters_are_refused_with_the_command(self):
        for ending in [".x3d", ".wrl", ".ac", ".acc", ".lwo", ".ms3d", ".B3D"]:
            self.says(f": {ending.lower()} is not read; convert it first, by Blender or by assimp-utils: "
                      f"assimp export 'a{ending}' 'a.glb'", "a" + ending, "x")

    def test_files_that_refer_to_themselves_are_refused(self):
        copy = '<instance_geometry url="#plate">'
        self.says(": <node> `wall` refers to itself; take the reference out", "a.dae",
                  COLLADA.replace(copy, '<instance_node url="#wall"/>' + copy))

    def test_elements_without_end_are_refused(self):
        deep = "is nested more than 200 deep, references included; export it again, or as .glb"
        nested = "<node>" * 20000 + "</node>" * 20000
        self.says(f": <node> {deep}", "a.dae", f"<COLLADA><library_nodes>{nested}</library_nodes></COLLADA>")
        nodes = '<node id="n0"/>'
        chain = nodes + "".join(f'<node id="n{k}"><instance_node url="#n{k - 1}"/></node>' for k in range(1, 200))
        self.says(f": <node> {deep}", "a.dae", f"<COLLADA><library_nodes>{chain}</library_nodes></COLLADA>")
        for k in range(1, 9):
            nodes += f'<node id="n{k}">' + f'<instance_node url="#n{k - 1}"/>' * 8 + "</node>"
        self.says(": its references stand for 4.4e+07 elements, over 1e+06; export it without instances, or as .glb",
                  "a.dae", f"<COLLADA><library_nodes>{nodes}</library_nodes></COLLADA>")

    def test_deep_nesting_is_refused_before_assimp_reads_it(self):
        deep = "are nested more than 1000 deep; export it again, or as .glb"
        self.says(f": its parts {deep}", "a.fbx", FBX + "A: {" * 20000)

        def fbx(models, pairs):
            objects = "".join(f'Model: {k}, "Model::m{k}", "Null" {{\n}}\n' for k in range(models))
            links = "".join(f'C: "OO",{child},{parent}\n' for child, parent in pairs)
            return f"; FBX 7.4.0 project file\nObjects:  {{\n{objects}}}\nConnections:  {{\n{links}}}\n"

        self.says(": a model contains itself, by way of others; export it again", "a.fbx",
                  fbx(3, [(0, 9), (1, 0), (2, 1), (1, 2)]))
        self.says(f": models {deep}", "a.fbx", fbx(2000, [(k, k - 1) for k in range(1, 2000)]))
        # Binary FBX: records within records, each with its end, sizes and a name.
        record = b""
        for _ in range(2000):
            record = b"\0" * 12 + b"\1A" + record
        start = len(b"Kaydara FBX Binary  \0\x1a\0") + 4
        ends = bytearray(record)
        for k in range(2000):
            ends[14 * k:14 * k + 4] = struct.pack("<I", start + len(record))
        self.says(f": its parts {deep}", "a.fbx",
                  b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", 7400) + bytes(ends))

    def test_words_where_corners_are_due_are_refused(self):
        self.says(": <p> holds `inf`, which is no index of a corner; export it again", "a.dae",
                  COLLADA.replace("<p>0 1 2 3</p>", "<p>0 1 inf 3</p>"))

    def test_broken_files_of_assimp_are_one_line(self):
        for name, content in [("a.dae", COLLADA[:900]), ("a.fbx", FBX[:300]), ("a.dae", "hello"),
                              ("a.fbx", b"Kaydara FBX Binary  \0\x1a\0\xff\xff\xff\xff")]:
            with self.subTest(name=name):
                self.refuse("info", self.put(name, content), words=[f"radiosity: {name}: "])


class AssimpProcessTest(CliTest):
    """Assimp runs in a process of its own, played here by programs that end as it does."""

    def run_with(self, script):
        """`info` of a copy of the program whose helper is a shell script."""
        folder = self.folder / "program"
        folder.mkdir()
        program = pathlib.Path(PROGRAM)
        shutil.copy(program, folder / "radiosity")
        for library in program.parent.glob("libradiosity*"):
            (folder / library.name).symlink_to(library)
        if script is not None:
            helper = folder / "radiosity-assimp"
            helper.write_text("#!/bin/sh\n" + script)
            helper.chmod(0o755)
        (self.folder / "a.dae").write_text(COLLADA)
        return subprocess.run([folder / "radiosity", "info", "a.dae"], cwd=self.folder, capture_output=True,
                              env={**os.environ, "LD_LIBRARY_PATH": ""}, text=True, timeout=limit(60))

    def assert_says(self, run, code, line):
        self.assertEqual((run.returncode, run.stdout, run.stderr), (code, "", f"radiosity: {line}\n"))

    CURE = (": Assimp, the library that reads this format, gave up; export it again, or save it as glTF "
            "or OBJ")

    def test_an_abort_is_one_line(self):
        run = self.run_with("echo noise; echo noise >&2; kill -ABRT $$")
        self.assert_says(run, 2, "a.dae: is damaged" + self.CURE)

    def test_limits_are_named(self):
        self.assert_says(self.run_with("exit 3"), 2,
                         "a.dae: needs far more memory than its size explains" + self.CURE)

    def test_too_much_time_is_named(self):
        self.assert_says(self.run_with("kill -XCPU $$"), 2,
                         "a.dae: takes far longer than its size explains" + self.CURE)

    def test_an_answer_that_is_none_is_refused(self):
        run = self.run_with("head -c 100000 /dev/zero >&0; exit 0")
        self.assert_says(run, 2, "a.dae: is damaged" + self.CURE)

    def test_a_missing_helper_is_named(self):
        run = self.run_with(None)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"\Aradiosity: radiosity-assimp cannot be used \(no such file\); "
                                     r"install it again [^\n]*\n\Z")

    def test_it_ends_with_the_program(self):
        ours, its = socket.socketpair()
        helper = pathlib.Path(PROGRAM).parent / "radiosity-assimp"
        starts = "import os, subprocess, sys; subprocess.run([sys.argv[1], str(os.getpid())], stdin=0)"
        with ours, subprocess.Popen([sys.executable, "-c", starts, helper], stdin=its) as program:
            its.close()
            ours.settimeout(0.5)
            with self.assertRaises(TimeoutError):  # it waits for a request
                ours.recv(1)
            program.kill()
            ours.settimeout(30)
            self.assertEqual(ours.recv(1), b"")  # nobody holds its end any more


if __name__ == "__main__":
    sys.exit(unittest.main())
