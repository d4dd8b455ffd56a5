"""VRML 2.0, which is read as X3D: names, colours, sides, copies, viewpoints, and files that are broken."""

import gzip
import unittest

from cli_runner import CliTest

HEAD = "#VRML V2.0 utf8\n"
PLATE = """geometry IndexedFaceSet {
  coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0  # the upper corners
                             0 1 0 ] }
  coordIndex [ 0, 1, 2, 3, -1 ] %s }"""
WALL = HEAD + """DEF wall Transform { translation 0 0 1 children [
  Shape { appearance Appearance { material DEF paint Material {
      diffuseColor .25 .5 .75 emissiveColor 2 1 0 } }
    %s } ] }
""" % (PLATE % "")


class Vrml(CliTest):
    def put(self, content, name="a.wrl"):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def scene(self, content):
        return self.report("info", self.put(content))["scene"]

    def says(self, line, content):
        self.assertEqual(self.refuse("info", self.put(content)), "radiosity: a.wrl" + line)

    def test_names_colours_and_places(self):
        scene = self.scene(WALL)
        self.assertEqual([[s["name"], s["faces"], s["area_m2"]] for s in scene["surfaces"]],
                         [["wall/paint", 1, 1]])
        material = scene["materials"][0]
        self.assertEqual([material["reflectance"], material["radiance_W_per_m2_sr"], material["sides"]],
                         ["0.25, 0.5, 0.75", "2, 1, 0", "one"])
        self.run_program("mesh", "a.wrl", "--patches", "1", "-o", "m.obj")
        corners = [line.split()[1:] for line in (self.folder / "m.obj").read_text().splitlines()
                   if line.startswith("v ")]
        self.assertEqual(sorted(tuple(map(float, c)) for c in corners),
                         [(0, 0, 1), (0, 1, 1), (1, 0, 1), (1, 1, 1)])

    def test_materials_have_their_names_and_equal_ones_without_a_name_are_one(self):
        shape = "Shape { appearance %s { material %s } geometry Box { size 1 1 1 } }\n"
        bare = "Material { diffuseColor 1 0 0 }"
        scene = self.scene(HEAD + shape % ("Appearance", "DEF PIN-01 Material { diffuseColor .5 .5 .5 }") +
                           shape % ("Appearance", "USE PIN-01") + shape % ("DEF lacquer Appearance", bare) +
                           shape % ("Appearance", bare) + shape % ("Appearance", bare))
        self.assertEqual([[s["name"], s["faces"]] for s in scene["surfaces"]],
                         [["a/PIN-01", 12], ["a/lacquer", 6], ["a/material 3", 12]])
        self.assertEqual([m["name"] for m in scene["materials"]], ["PIN-01", "lacquer", "material 3"])

    def test_lines_and_points_are_left_out(self):
        """Assimp refuses a whole file for a line of one point."""
        line = "DEF rope Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 0 0 ] } coordIndex [ 0, -1 ] } }"
        points = "Shape { geometry PointSet { coord Coordinate { point [ 0 0 0, 1 0 0 ] } } }"
        scene = self.scene(WALL + line + points)
        self.assertEqual([s["name"] for s in scene["surfaces"]], ["wall/paint"])
        self.assertIn("lines and points have no area and are left out, in: rope, a shape without a name",
                      self.run_program("info", "a.wrl").out)

    def test_line_ends_of_other_systems(self):
        for end in ["\r\n", "\r"]:
            with self.subTest(end=end):
                self.assertEqual(self.scene(WALL.replace("\n", end))["surfaces"][0]["area_m2"], 1)

    def test_copies_are_all_there(self):
        scene = self.scene(WALL + "Transform { translation 3 0 0 children USE wall }\n"
                                  "Transform { translation 6 0 0 children [ USE wall USE wall ] }\n")
        self.assertEqual(sum(s["area_m2"] for s in scene["surfaces"]), 4)

    def test_shapes_that_are_not_solid_have_two_sides(self):
        scene = self.scene(HEAD + "Shape { %s }" % (PLATE % "solid FALSE"))
        surface = scene["surfaces"][0]
        self.assertEqual(next(m["sides"] for m in scene["materials"] if m["name"] == surface["material"]), "two")

    def test_boxes_viewpoints_and_what_makes_no_shape(self):
        scene = self.scene(HEAD + """
          WorldInfo { title "a \\"test\\" # no comment" info [ "x", "y" ] }
          Viewpoint { position 0 0 5 fieldOfView .5 description "front" }
          PROTO Chair [ field SFInt32 legs 4 eventIn SFBool sit ] { Group { children [ Shape { } ] } }
          EXTERNPROTO Table [ field SFInt32 legs ] [ "table.wrl" ]
          Chair { legs 3 }
          Script { url "javascript: function f() { return 1; }" field SFBool open TRUE }
          DEF clock TimeSensor { loop TRUE }
          Collision { proxy Shape { geometry Box { size 9 9 9 } } children Shape { geometry Box { size 1 2 3 } } }
          ROUTE clock.fraction_changed TO wall.set_fraction
        """)
        self.assertEqual([s["area_m2"] for s in scene["surfaces"]], [22])
        self.assertEqual([scene["cameras"][0]["name"], scene["cameras"][0]["eye_m"]], ["front", "0, 0, 5"])
        self.assertIn("nodes that the file defines itself (PROTO) are left out: Chair, Table",
                      self.run_program("info", "a.wrl").err)

    def test_other_files_inside(self):
        self.put(WALL, "inner.wrl")
        outer = HEAD + 'Transform { translation 5 0 0 children Inline { url [ "inner.wrl" "http://b/inner.wrl" ] } }'
        self.assertEqual(self.scene(outer)["surfaces"][0]["area_m2"], 1)
        self.assertEqual(self.refuse("info", self.put(outer.replace('"inner', '"gone'))),
                         "radiosity: gone.wrl: no such file; check the name and the folder")

    def test_broken_files_are_refused_in_a_line(self):
        for line, content in [
                (":1: is no VRML file, which begins with #VRML V2.0 utf8; export it", "Shape { }"),
                (":1: VRML 1.0 is not read; export it as VRML 2.0 (VRML97), .x3d or .glb", "#VRML V1.0 ascii\n"),
                (": is packed by gzip; unpack it: gunzip -c a.wrl > unpacked.wrl", gzip.compress(WALL.encode())),
                (":2: Shape has no end, a } is missing; export it again", HEAD + "Shape { geometry Box { }"),
                (":3: a ] is missing after children; export it again", HEAD + "Group { children [\nGroup { }"),
                (":2: a string has no end; export the file again", HEAD + 'Group { x "abc\n\n'),
                (":2: `x` is no value of size; export the file again", HEAD + "Shape { geometry Box { size [1 1 x] } }"),
                (":2: USE a: no node before it has that name; export it again", HEAD + "USE a"),
                (":2: `}` is no name of a node; export it again", HEAD + "}"),
                (":2: `7` is no name of a field of Group; export it again", HEAD + "Group { 7 }"),
                (":2: a } is missing; export the file again", HEAD + "Script { { }"),
                (":2: `Box` stands where Shape needs {; export the file again", HEAD + "Shape Box { }"),
                (":2: nodes are nested more than 200 deep; export it again, or as .glb",
                 HEAD + "Group { children " * 3000)]:
            with self.subTest(line=line):
                self.says(line, content)


if __name__ == "__main__":
    unittest.main()
