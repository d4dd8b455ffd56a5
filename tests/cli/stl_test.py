"""STL as a scene: text and binary, sound and broken, each broken one with its exact line."""

import struct
import sys
import unittest

import input_files
from cli_runner import CliTest

# A tetrahedron with a lamp's face: a scene of triangles that can be meshed and lit.
CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 1, 2), (0, 3, 1), (0, 2, 3), (1, 3, 2)]  # seen from inside


def tetrahedron(solids):
    text = ""
    for name, faces in solids:
        text += f"solid {name}\n"
        for face in faces:
            vertices = "".join("vertex {} {} {}\n".format(*CORNERS[c]) for c in face)
            text += f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n"
        text += f"endsolid {name}\n"
    return text


class Stl(CliTest):
    def put(self, content, name="a.stl"):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def scene(self, name="a.stl", *options):
        return self.report("info", name, *options)["scene"]

    def says(self, line, content):
        self.assertEqual(self.refuse("info", self.put(content)), "radiosity: a.stl" + line)

    def test_named_solids_are_surfaces_and_corners_are_welded(self):
        self.put(tetrahedron([("floor slab", FACES[:1]), ("walls", FACES[1:])]))
        scene = self.scene()
        self.assertEqual([s["name"] for s in scene["surfaces"]], ["floor slab", "walls"])
        self.assertEqual([scene["faces"], scene["vertices"], scene["watertight"]], [4, 4, True])

    def test_text_and_binary_are_the_same_scene(self):
        records = b"".join(struct.pack("<12fH", 0, 0, 0, *CORNERS[a], *CORNERS[b], *CORNERS[c], 0)
                           for a, b, c in FACES)
        binary = b"solid so called".ljust(80) + struct.pack("<I", 4) + records
        self.put(tetrahedron([("a", FACES)]))
        text_scene = self.scene()
        self.put(binary)
        self.assertEqual(self.scene(), text_scene)

    def test_a_solid_can_be_lit(self):
        self.put(tetrahedron([("lamp", FACES[:1]), ("walls", FACES[1:])]))
        self.run_program("solve", "a.stl", "--patches", "40", "--set", "lamp.radiance=10", "-o", "s.h5")
        self.assertIn("lamp: reflectance 0.5 -> 0.8",
                      self.run_program("solve", "s.h5", "--set", "lamp.reflectance=.8").out)

    def test_units_apply_and_keywords_ignore_case(self):
        self.put(tetrahedron([("a", FACES)]).upper())
        self.assertEqual(self.scene("a.stl", "--unit", "mm")["upper_m"], [0.001, 0.001, 0.001])

    def test_notes_name_wrong_normals_and_trailing_bytes(self):
        self.put(input_files.ascii_stl("plate").replace("normal 0 0 1", "normal 0 0 -1"))
        self.assertIn("1 of 1 normals point against the order of the corners; the order counts",
                      self.run_program("info", "a.stl").err)
        self.put(input_files.binary_stl(2) + b"more")
        run = self.run_program("info", "a.stl")
        self.assertIn("4 bytes after the last triangle are left out", run.err)
        self.assertIn("no material, reflectance 0.5: a", run.err)

    def test_broken_text_is_refused_by_line(self):
        text = input_files.ascii_stl()
        for old, new, line in [
                ("vertex 1 0 0", "vertex 1 nan 0", ":5: `nan` is not a finite number; write it as 1.5 "
                                                   "with a decimal point"),
                ("vertex 1 0 0", "vertex 1 1,5 0", ":5: `1,5` is not a finite number; write it as 1.5 "
                                                   "with a decimal point"),
                ("vertex 1 0 0", "vertex 1 0", ":5: a vertex has 3 coordinates, not 2; correct the line"),
                ("      vertex 1 0 0\n", "", ":7: a facet of 2 vertices needs 3; correct or remove it"),
                ("vertex 1 0 0\n", "vertex 1 0 0\nvertex 2 0 0\n",
                 ":7: a facet of more than 3 vertices; export triangles"),
                ("  endfacet\n", "", ":8: `endsolid` within a facet; end it with endfacet"),
                ("  facet normal 0 0 1\n", "", ":3: a vertex outside a facet; export the file again"),
                ("vertex 1 0 0", "point 1 0 0", ":5: `point` is no statement of an STL file; correct it "
                                                "or export again"),
                ("    endloop\n  endfacet\nendsolid plate\n", "",
                 ":6: the file is cut off within a facet; export it again"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))
        self.says(": no faces; export the scene with its meshes", "solid nothing\nendsolid\n")

    def test_broken_binary_is_refused(self):
        whole = input_files.binary_stl(3)
        self.says(": is cut off or no STL: it claims 3 triangles and holds 2; export it again", whole[:-1])
        self.says(": is cut off or no STL: it claims 4294967295 triangles and holds 3; export it again",
                  input_files.binary_stl(3, claimed=2**32 - 1))
        # "solid" at the beginning does not make it text.
        self.says(": is cut off or no STL: it claims 3 triangles and holds 2; export it again",
                  input_files.binary_stl(3, header=b"solid made by hand")[:-1])
        self.says(": is no STL: neither text that begins with solid nor binary; export it again", "hello")
        self.says(": no faces; export the scene with its meshes", input_files.binary_stl(0))
        endless = bytearray(whole)
        endless[84 + 50 + 12:84 + 50 + 16] = struct.pack("<f", float("inf"))
        self.says(": triangle 1 has a coordinate that is not finite; export it again", bytes(endless))


if __name__ == "__main__":
    sys.exit(unittest.main())
