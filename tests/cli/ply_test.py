"""PLY as a scene: its properties, and each broken file with its exact line."""

import struct
import sys
import unittest

import mesh_files
from cli_runner import CliTest

MESH = mesh_files.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], {"plate": [[0, 1, 2, 3]]})
HEAD = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
element face 2
property uchar intensity
property list uchar int vertex_index
property int material_index
element edge 1
property int vertex1
property int vertex2
end_header
"""
BODY = "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n7 3 0 1 2 5\n7 3 0 2 3 6\n0 1\n"


class Ply(CliTest):
    def put(self, content, name="a.ply"):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def areas(self, name="a.ply"):
        return {s["name"]: s["area_m2"] for s in self.report("info", name)["scene"]["surfaces"]}

    def says(self, line, content):
        self.assertEqual(self.refuse("info", self.put(content)), "radiosity: a.ply" + line)

    def test_groups_are_surfaces_and_other_properties_are_skipped(self):
        self.put(HEAD + BODY)
        self.assertEqual(self.areas(), {"material_index 5": .5, "material_index 6": .5})

    def test_an_element_is_there_once(self):
        self.says(":9: there are two elements called vertex; export it again", """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
element vertex 1
property uchar red
end_header
""")

    def test_a_file_without_groups_is_one_surface_named_after_it(self):
        text = (HEAD + BODY).replace("property int material_index\n", "").replace(" 5\n", "\n").replace(" 6\n", "\n")
        self.put(text, "north wall.ply")
        self.assertEqual(self.areas("north wall.ply"), {"north wall": 1})
        # Line ends of another system, also behind the header of a binary file.
        self.put(text.replace("\n", "\r\n"), "b.ply")
        self.assertEqual(self.areas("b.ply"), {"b": 1})
        for order in ["little", "big"]:
            whole = mesh_files.to_ply(MESH, f"binary_{order}_endian")
            head, body = whole.split(b"end_header\n")
            self.put(head.replace(b"\n", b"\r\n") + b"end_header\r\n" + body + b"more")
            self.assertEqual(self.areas(), {"group 1": 1})
            self.assertIn("what stands after the last element of the file is left out",
                          self.run_program("info", "a.ply").err)

    def test_broken_text_is_refused_by_line(self):
        text = HEAD + BODY
        for old, new, line in [
                ("ply\n", "plyy\n", ":1: is no PLY file, which begins with ply; export it"),
                ("ascii", "utf8", ":2: format utf8 is not read; export it again"),
                ("element vertex 4", "element vertex -4", ":3: `-4` is not a whole number of 0 or more; correct it"),
                ("element vertex 4", "element vertex 4000000000", ":16: element vertex 4000000000: the file is too "
                 "short for so many; it is cut off or damaged, export it again"),
                ("float y", "float w", ":16: vertices have no y; export the file again"),
                ("float y", "real y", ":5: `real` is no type of a PLY file; export it again"),
                ("list uchar int vertex_index", "list uchar int corners", ":19: faces have no list vertex_indices; "
                 "export the file again"),
                ("list uchar int", "list float int", ":10: the length of a list is a whole number; export the file "
                                                     "again"),
                ("end_header\n", "", ":15: `0` does not belong in the header of a PLY file like this; export it again"),
                ("1 0 0 9", "1 inf 0 9", ":17: coordinate `inf` is not a finite number; write it as 1.5 with a "
                                         "decimal point"),
                ("3 0 1 2 5", "3 0 1 4 5", ":20: vertex 4 of face 0 does not exist, there are 4 (from 0); correct it"),
                ("3 0 1 2 5", "3 0 1 -1 5", ":20: vertex -1 of face 0 does not exist, there are 4 (from 0); correct it"),
                ("3 0 1 2 5", "2 0 1 5", ":20: face 0 has 2 corners, it needs 3 or more; correct or remove it"),
                ("3 0 2 3 6\n0 1\n", "3 0 2", ":21: number of corners 3: the file is too short for so "
                 "many; it is cut off or damaged, export it again"),
                ("element edge", "element tristrips", ":12: strips of triangles are not read; export the faces one by "
                                                      "one"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))

    def test_broken_binary_is_refused(self):
        whole = mesh_files.to_ply(MESH, "binary_little_endian")
        nan = struct.pack("<d", float("nan"))
        place = whole.index(b"end_header\n") + 11
        self.says(f": byte {place + 8}: a coordinate is not a finite number; export the file again",
                  whole[:place] + nan + whole[place + 8:])
        self.refuse("info", self.put(whole.replace(b"element face 1", b"element face 4294967295")),
                    words=["a.ply: byte ", "element face 4294967295: the file is too short for so many"])
        self.says(": is a cloud of 4 points without faces; make a surface of it first (in MeshLab: Filters, "
                  "Remeshing, Surface Reconstruction)", whole.replace(b"element face 1", b"element face 0"))
        self.says(": no faces; export the scene with its faces", "ply\nformat ascii 1.0\nelement vertex 0\nproperty "
                  "float x\nproperty float y\nproperty float z\nend_header\n")


if __name__ == "__main__":
    sys.exit(unittest.main())
