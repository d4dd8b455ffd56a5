"""3MF, as programs for CAD and printing write it: placed objects, units, names, colours, and damaged
archives, each refused in a line."""

import io
import random
import struct
import subprocess
import sys
import unittest
import zipfile

from cli_runner import PROGRAM, CliTest, limit

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONS = """<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>"""

# A tetrahedron with corners at the origin and at 1 on each axis: areas .5 three times and sqrt(3) / 2.
VERTICES = '<vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/>'
SLANTED = 3 ** .5 / 2


def mesh(first="", second="", corners="0 2 1,0 1 3,1 2 3,0 3 2"):
    """`first`, `second`: further attributes of the first two triangles."""
    triangles = ""
    for corner, more in zip(corners.split(","), [first, second, "", ""]):
        v1, v2, v3 = corner.split()
        triangles += f'<triangle v1="{v1}" v2="{v2}" v3="{v3}" {more}/>'
    return f"<mesh><vertices>{VERTICES}</vertices><triangles>{triangles}</triangles></mesh>"


def model(resources, build, attributes='unit="meter"', space=CORE):
    return (f'<?xml version="1.0" encoding="UTF-8"?><model {attributes} xmlns="{space}"><resources>{resources}'
            f"</resources><build>{build}</build></model>")


WEDGE = f'<object id="1" name="wedge">{mesh()}</object>'
ITEM = '<item objectid="1"/>'


def archive(text, packing=zipfile.ZIP_DEFLATED, others=None):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", packing) as file:
        file.writestr("_rels/.rels", RELATIONS)
        file.writestr("3D/3dmodel.model", text)
        for name, other in (others or {}).items():
            file.writestr(name, other)
    return content.getvalue()


class ThreeMf(CliTest):
    def put(self, content):
        (self.folder / "a.3mf").write_bytes(content if isinstance(content, bytes) else archive(content))
        return "a.3mf"

    def scene(self, content, *options):
        return self.report("info", self.put(content), *options)["scene"]

    def areas(self, content, *options):
        return {s["name"]: s["area_m2"] for s in self.scene(content, *options)["surfaces"]}

    def says(self, line, content):
        self.assertEqual(self.refuse("info", self.put(content)), f"radiosity: a.3mf: {line}")

    def test_units_become_metres(self):
        for attributes, unit in [("", .001), ('unit="millimeter"', .001), ('unit="micron"', 1e-6),
                                 ('unit="centimeter"', .01), ('unit="inch"', .0254), ('unit="foot"', .3048),
                                 ('unit="meter"', 1)]:
            with self.subTest(attributes):
                scene = self.scene(model(WEDGE, ITEM, attributes))
                for size in scene["extent_m"]:
                    self.assertAlmostEqual(size / unit, 1, 5)  # of six digits
        # --unit overrides the file.
        scene = self.scene(model(WEDGE, ITEM, ""), "--unit", "m")
        self.assertEqual(scene["extent_m"], [1, 1, 1])
        self.says("its unit `league` is none of micron, millimeter, centimeter, inch, foot, meter; correct it",
                  model(WEDGE, ITEM, 'unit="league"'))

    def test_items_and_components_are_placed(self):
        # Twice as large, then 10 along x; in it the wedge, and the wedge moved by 5, 6, 7. A mirrored wedge beside.
        resources = (WEDGE + '<object id="2" name="pair"><components><component objectid="1"/>'
                     '<component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 6 7"/></components></object>')
        build = ('<item objectid="2" transform="2 0 0 0 2 0 0 0 2 10 0 0"/>'
                 '<item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 -3 0"/>')
        scene = self.scene(model(resources, build))
        self.assertEqual(scene["lower_m"], [-1, -3, 0])
        self.assertEqual(scene["upper_m"], [22, 14, 16])
        areas = {s["name"]: s["area_m2"] for s in scene["surfaces"]}
        self.assertEqual(list(areas), ["wedge", "wedge#2", "wedge#3"])
        for name, times in [("wedge", 4), ("wedge#2", 4), ("wedge#3", 1)]:
            self.assertAlmostEqual(areas[name], times * (1.5 + SLANTED), 4)
        self.assertTrue(scene["watertight"])
        self.assertNotIn("faces inwards", self.run_program("info", "a.3mf").err)  # the mirrored one neither
        # The rows turn an axis: x becomes y.
        scene = self.scene(model(WEDGE, '<item objectid="1" transform="0 2 0 3 0 0 0 0 1 0 0 0"/>'))
        self.assertEqual(scene["upper_m"], [3, 2, 1])

    def test_names_come_from_objects_and_components(self):
        # The object's own name, else its parent's, else its number; objects not built are left out.
        resources = (f'<object id="1">{mesh()}</object><object id="2" name="lid"><components><component objectid="1"/>'
                     f'</components></object><object id="3" name="spare">{mesh()}</object>')
        text = model(resources, '<item objectid="2"/><item objectid="1"/>')
        self.assertEqual(list(self.areas(text)), ["lid", "object 1"])
        run = self.run_program("info", "a.3mf")
        self.assertIn("objects that the build does not place are left out: spare", run.err)
        self.assertIn("no material, reflectance 0.5: lid, object 1", run.err)

    def test_materials_come_from_the_colours_of_triangles(self):
        groups = ('<basematerials id="5"><base name="red" displaycolor="#FF8000FF"/><base name="grey" '
                  'displaycolor="#33333380"/></basematerials><m:colorgroup id="6"><m:color color="#000000"/>'
                  '<m:color color="#FFFFFF"/></m:colorgroup><m:texture2dgroup id="7" texid="8"/>')
        space = f'{CORE}" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02'
        body = mesh('pid="5" p1="1"', 'pid="6" p1="0" p2="0" p3="0"')
        plain = mesh('pid="6" p1="0" p2="1" p3="1"', 'pid="7" p1="0"')
        text = model(f'{groups}<object id="1" name="a" pid="5" pindex="0">{body}</object>'
                     f'<object id="2" name="b">{plain}</object>', ITEM + '<item objectid="2"/>', space=space)
        scene = self.scene(text)
        surfaces = {s["name"]: s["faces"] for s in scene["surfaces"]}
        self.assertEqual(surfaces, {"a/grey": 1, "a/colour #000000": 1, "a/red": 2, "b": 4})
        colours = {m["name"]: [float(x) for x in m["reflectance"].split(",")] for m in scene["materials"]}
        self.assertEqual([colours["b"], colours["colour #000000"]], [[.5] * 3, [0] * 3])
        middle = ((128 / 255 + .055) / 1.055) ** 2.4  # sRGB, IEC 61966-2-1
        dark = ((51 / 255 + .055) / 1.055) ** 2.4
        for name, expected in [("red", [1, middle, 0]), ("grey", [dark] * 3)]:
            for found, value in zip(colours[name], expected):
                self.assertAlmostEqual(found, value, 5)
        err = self.run_program("info", "a.3mf").err
        for words in ["(--without NAME leaves it out), material: grey",
                      "colours that change over a triangle are not read, default reflectance there, in: b",
                      "multiproperties) are not read, default reflectance for: b", "reflectance 0.5: b"]:
            self.assertIn(words, err)

    def test_components_in_other_files_are_read(self):
        # As in the production extension, and in all programs that print from several plates.
        part = model(f'<object id="1">{mesh()}</object>', "")
        space = f'{CORE}" xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06'
        text = model('<object id="8" name="body"><components><component p:path="/3D/Objects/one.model" objectid="1"/>'
                     '</components></object>', '<item objectid="8"/>', 'unit="meter" requiredextensions="p"', space)
        areas = self.areas(archive(text, others={"3D/Objects/one.model": part}))
        self.assertEqual(list(areas), ["body"])
        self.assertNotIn("extensions", self.run_program("info", "a.3mf").err)
        self.says("is no 3MF file: its archive has no /3D/Objects/one.model; export it again", archive(text))

    def test_unread_extensions_are_named(self):
        space = f'{CORE}" xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02'
        lattice = WEDGE.replace("</mesh>", "<b:beamlattice/></mesh>")
        self.put(model(lattice, ITEM, 'unit="meter" requiredextensions="b"', space))
        err = self.run_program("info", "a.3mf").err
        self.assertIn("extensions that the file needs and that are not read: http://schemas.microsoft.com/"
                      "3dmanufacturing/beamlattice/2017/02", err)
        self.assertIn("beams of lattices are left out, in: wedge", err)

    def test_stored_files_and_comments_are_read(self):
        content = archive(model(WEDGE, ITEM), zipfile.ZIP_STORED)
        comment = b"made by hand"
        content = content[:-2] + struct.pack("<H", len(comment)) + comment
        self.assertEqual(list(self.areas(content)), ["wedge"])

    def test_the_form_of_large_archives_is_read(self):
        # Sizes and places in 64 bits, as by writers that do not know them beforehand.
        text = archive(model(WEDGE, ITEM))
        end = text.rindex(b"PK\5\6")
        count, size, place = struct.unpack("<HII", text[end + 10:end + 20])
        entries, at = b"", place
        for _ in range(count):
            head = bytearray(text[at:at + 46])
            packed, whole = struct.unpack("<II", head[20:28])
            name, extra, _ = struct.unpack("<HHH", head[28:34])
            offset, = struct.unpack("<I", head[42:46])
            head[20:28] = b"\xff" * 8
            head[42:46] = b"\xff" * 4
            large = struct.pack("<HHQQQ", 1, 24, whole, packed, offset)
            head[30:32] = struct.pack("<H", len(large))
            entries += bytes(head) + text[at + 46:at + 46 + name] + large
            at += 46 + name + extra
        large_end = struct.pack("<IQHHIIQQQQ", 0x06064b50, 44, 45, 45, 0, 0, count, count, len(entries), place)
        locator = struct.pack("<IIQI", 0x07064b50, 0, place + len(entries), 1)
        short_end = struct.pack("<IHHHHIIH", 0x06054b50, 0, 0, 0xffff, 0xffff, 0xffffffff, 0xffffffff, 0)
        self.assertEqual(at, place + size)
        self.assertEqual(list(self.areas(text[:place] + entries + large_end + locator + short_end)), ["wedge"])

    def test_broken_models_are_refused(self):
        text = model(WEDGE, ITEM)
        for old, new, line in [
                ('x="1"', 'x="nan"', "object wedge: vertex 1: x `nan` is not a finite number; correct it"),
                (' x="1"', "", "object wedge: vertex 1: x `` is not a finite number; correct it"),
                ('v3="1"', 'v3="4"', "object wedge: triangle 0: vertex `4` does not exist, there are 4 (from 0); "
                                     "correct it"),
                ('v3="1"', 'v3="-1"', "object wedge: triangle 0: vertex `-1` does not exist, there are 4 (from 0); "
                                      "correct it"),
                (ITEM, "", "no faces: its build places no object with triangles; export it again"),
                (ITEM, '<item objectid="2"/>', "object `2`, which the build or a component names, does not exist; "
                                               "export it again"),
                (ITEM, '<item objectid="1" transform="1 2 3"/>', "transform `1 2 3` has 3 numbers, not 12; correct it"),
                (ITEM, '<item objectid="1" transform="1 0 0 0 1 0 0 0 z 0 0 0"/>',
                 "transform `1 0 0 0 1 0 0 0 z 0 0 0` is not 12 finite numbers; correct it"),
                ('name="wedge"', 'name="wedge" pid="9" pindex="0"', "object wedge: its group of materials 9 does not "
                                                                    "exist; export it again"),
                ("</resources>", WEDGE + "</resources>", "/3D/3dmodel.model: two resources have the id `1`; export it "
                                                         "again"),
                ("<resources>", "<resource>", f"/3D/3dmodel.model: is no sound XML (byte {text.index('</resources>') + 1}"
                                              ": Start-end tags mismatch); export it again"),
                (f"<mesh>{mesh()[6:]}", '<components><component objectid="1"/></components>',
                 "its components are more than 1048576, or in a ring; export it again"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))
        base = '<basematerials id="5"><base name="red" displaycolor="{}"/></basematerials>'
        named = WEDGE.replace('name="wedge"', 'name="wedge" pid="5" pindex="{}"')
        self.says("material red: its colour `red` is not #RRGGBB or #RRGGBBAA; correct it",
                  model(base.format("red") + named.format(0), ITEM))
        self.says("material red: its colour `#GG0000` is not #RRGGBB or #RRGGBBAA; correct it",
                  model(base.format("#GG0000") + named.format(0), ITEM))
        self.says("object wedge: member `1` of its group of materials 5 does not exist; export it again",
                  model(base.format("#FF0000") + named.format(1), ITEM))

    def test_damaged_archives_are_refused(self):
        whole = archive(model(WEDGE, ITEM))
        self.says("is no zip archive, which begins with PK; export it again", model(WEDGE, ITEM).encode())
        self.says("the list of its files, at its end, is not there; it is cut off, export it again", whole[:-40])
        empty = io.BytesIO()
        zipfile.ZipFile(empty, "w").close()
        self.says("is no 3MF file: its archive has no _rels/.rels; export it again", empty.getvalue())
        self.says("_rels/.rels: is packed by method 12, which is not read; pack it by deflate",
                  archive(model(WEDGE, ITEM), zipfile.ZIP_BZIP2))
        entry = whole.rindex(b"PK\1\2")
        for at, change, line in [
                (8, struct.pack("<H", 1), "is encrypted; save it without a password"),
                (16, b"\0\0\0\0", "its checksum is wrong; the archive is damaged, export it again"),
                (24, struct.pack("<I", 0x7fffffff), "its size is wrong; the archive is damaged, export it again"),
                (24, struct.pack("<I", 0x80000000), "unpacks to 2147483648 bytes, more than are read; split the scene"),
                (24, struct.pack("<I", 99), "cannot be unpacked; the archive is damaged, export it again"),
        ]:
            with self.subTest(line):
                self.says(f"3D/3dmodel.model: {line}", whole[:entry + at] + change + whole[entry + at + len(change):])
        for at, change in [(20, b"\xff\xff\xff\x7f"), (28, b"\xff\xff"), (42, b"\xff\xff\xff\x00"), (0, b"PK\3\4")]:
            with self.subTest(at=at):
                self.says("the list of its files is damaged or cut off; export it again",
                          whole[:entry + at] + change + whole[entry + at + len(change):])

    def test_random_damage_is_read_or_refused_in_a_line(self):
        whole = archive(model(WEDGE, ITEM))
        chance = random.Random(3)
        for _ in range(150):
            broken = bytearray(whole)
            for _ in range(chance.randint(1, 3)):
                broken[chance.randrange(len(broken))] = chance.randrange(256)
            self.put(bytes(broken[:chance.choice([len(broken), chance.randrange(1, len(broken))])]))
            run = subprocess.run([PROGRAM, "info", "a.3mf"], cwd=self.folder, capture_output=True,
                                 text=True, timeout=limit(60),
                                 check=False)
            self.assertIn(run.returncode, (0, 2), run.stderr)
            if run.returncode == 2:
                self.assertRegex(run.stderr, r"\Aradiosity: a\.3mf: [^\n]+\n\Z")


if __name__ == "__main__":
    sys.exit(unittest.main())
