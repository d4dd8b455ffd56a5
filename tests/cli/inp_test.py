"""CalculiX and Abaqus input as scenes: shells, sets, includes, and each broken file with its line."""

import json
import sys
import unittest

from cli_runner import CliTest

HEAD = """*HEADING
 a plate of two squares
** a comment
*NODE, NSET=Nall
1, 0., 0., 0.
2, 1., 0.
3, 1.D0, 1., 0.
4, 0., 1., 0.
5, 2., 0., 0.
6, 2., 1., 0.
"""
TWO = "*ELEMENT, TYPE=S4, ELSET=Surface1\n1, 1,2,3,4\n2, 2,5,6,3\n"


class Inp(CliTest):
    def put(self, text, name="a.inp"):
        return self.write(name, text)

    def surfaces(self, text):
        self.put(text)
        return {s["name"]: s["area_m2"] for s in self.report("info", "a.inp")["scene"]["surfaces"]}

    def says(self, line, text):
        self.assertEqual(self.refuse("info", self.put(text)), "radiosity: a.inp" + line)

    def test_shells_of_every_order_are_read(self):
        mid = "".join(f"{k}, {x}, {y}, 0.\n" for k, x, y in
                      [(11, .5, 0), (12, 1, .5), (13, .5, 1), (14, 0, .5), (15, .5, .5)])
        for kind, nodes, area in [("S3", "1,2,3", .5), ("stri65", "1,2,3,11,12,15", .5), ("S6", "1,2,3,11,12,15", .5),
                                  ("S4R", "1,2,3,4", 1), ("M3D4", "1,2,3,4", 1), ("CPS4", "1,2,3,4", 1),
                                  ("S8R", "1,2,3,4,11,12,13,14", 1), ("DS8", "1,2,3,4,\n11,12,13,\n14", 1),
                                  ("S9R5", "1,2,3,4,11,12,13,14,15", 1)]:
            with self.subTest(kind=kind):
                self.assertEqual(self.surfaces(f"{HEAD}{mid}*Element, type={kind}, Elset=Plate\n7, {nodes}\n"),
                                 {"Plate": area})

    def test_sets_are_surfaces(self):
        # A mesher's sets of everything and of each part yield to those of *ELSET.
        text = HEAD + TWO + "*ELSET, ELSET=Eall\n1, 2\n"
        self.assertEqual(self.surfaces(text), {"Surface1": 2})  # both have all: the first
        self.assertEqual(self.surfaces(text + "*elset, elset=LEFT\n1,\n*ELSET, ELSET=right, GENERATE\n2, 2, 1\n"),
                         {"LEFT": 1, "right": 1})
        self.assertEqual(self.surfaces(text + "*ELSET, ELSET=left\n1\n"), {"left": 1, "Surface1": 1})
        self.assertIn("and leave these to them: Surface1, Eall", self.run_program("info", "a.inp").out)
        # A set of a set, and one with its name spelt in two ways.
        self.assertEqual(self.surfaces(text + "*ELSET, ELSET=a\n1\n*ELSET, ELSET=b\nA\n*ELSET,ELSET=B\n"),
                         {"a": 1, "Surface1": 1})
        self.assertEqual(self.surfaces(HEAD + TWO.replace(", ELSET=Surface1", "")), {"unnamed": 2})

    def test_volumes_and_beams_are_left_out(self):
        text = HEAD + TWO + "*ELEMENT, TYPE=C3D4, ELSET=body\n3, 1,2,3,4\n*ELEMENT, TYPE=B31\n4, 1, 2\n*STEP\n1, 2, junk\n"
        self.assertEqual(self.surfaces(text), {"Surface1": 2})
        self.assertIn("elements that are no faces (volumes, beams, ...) are left out, of type: C3D4, B31",
                      self.run_program("info", "a.inp").err)

    def test_volumes_alone_are_read_by_their_skin(self):
        nodes = "*NODE\n" + "".join(f"{12 * z + 4 * y + x + 1}, {x}, {y}, {z}\n"
                                    for z in range(3) for y in range(3) for x in range(4))
        cubes = [(12 * z + 4 * y + x + 1) for z in range(2) for y in range(2) for x in range(3)]
        bricks = [",".join(str(a + d) for d in [0, 1, 5, 4, 12, 13, 17, 16]) for a in cubes]
        text = nodes + "*ELEMENT, TYPE=DC3D8, ELSET=lower\n" + "".join(
            f"{k + 1}, {b}\n" for k, b in enumerate(bricks[:6])) + "*ELEMENT, TYPE=C3D8R, ELSET=upper\n" + "".join(
            f"{k + 7}, {b}\n" for k, b in enumerate(bricks[6:])) + "*ELEMENT, TYPE=SPRINGA\n99, 1, 2\n"
        self.assertEqual(self.surfaces(text), {"lower": 6 + 10, "upper": 6 + 10})
        run = self.run_program("info", "a.inp")
        self.assertIn("no faces, volume elements alone (12): the sides that no two of them share are the surfaces (32)",
                      run.err)
        self.assertRegex(run.out, r"watertight +yes")
        self.assertNotIn("flipped", run.err)
        # Sides named by *SURFACE are surfaces of that name.
        named = text + ("*SURFACE, NAME=hot, TYPE=ELEMENT\nupper, S2\n*SURFACE, NAME=other, TYPE=NODE\n1\n"
                        "*SURFACE, NAME=corner\n1, S1\n1, S3\n1, S6\n12, S2\n12, S4\n7, SPOS\n")
        self.assertEqual(self.surfaces(named), {"lower": 13, "upper": 10 - 1, "hot": 6, "corner": 4})
        self.assertIn("leave these to them: corner", self.run_program("info", "a.inp").out)

    def test_instances_of_parts_lie_where_they_are_placed(self):
        part = "*Part, name=Plate\n" + HEAD[HEAD.index("*NODE"):] + TWO.replace(", ELSET=Surface1", "") + (
            "*Elset, elset=all, generate\n1, 2\n*End Part\n")
        assembly = ("*Assembly, name=A\n*Instance, name=low, part=plate\n*End Instance\n"
                    # Shifted, then turned over about its edge.
                    "*Instance, name=high, part=Plate\n0, 0, 1\n0, .5, 1, 1, .5, 1, 180\n*End Instance\n"
                    "*Node\n1, 50, 50, 50\n*Elset, elset=heater, instance=low\n1\n*Elset, elset=pair\nlow.2, HIGH.1\n"
                    "*Elset, elset=_s, internal, instance=high\n2\n*End Assembly\n")
        self.assertEqual(self.surfaces(part + assembly), {"heater": 1, "pair": 2, "high.all": 1})
        # The heater and the first square of the turned plate lie face to face: Howell C-11.
        self.run_program("factors", "a.inp", "--patches", "1", "--between", "groups", "-o", "t.json")
        table = json.loads((self.folder / "t.json").read_text())
        names = table["names"]
        self.assertAlmostEqual(table["form_factors"][names.index("heater")][names.index("pair")], 0.199825,
                               delta=1e-6)  # of its six digits

    def test_surfaces_name_the_sides_of_shells(self):
        shells = HEAD + TWO
        self.assertEqual(self.surfaces(shells + "*SURFACE, NAME=hot\nSurface1, SPOS\n"), {"hot": 2})
        self.assertEqual(self.surfaces(shells + "*SURFACE, NAME=hot\n1,\n"), {"hot": 1, "Surface1": 1})
        # A smaller set says more than a surface of all.
        self.assertEqual(self.surfaces(shells + '*ELSET, ELSET="a, b"\n1\n*SURFACE, NAME=hot\nSurface1\n'),
                         {"a, b": 1, "hot": 1})
        self.assertEqual(self.surfaces(shells + '*ELSET, ELSET="a, b"\n1\n*SURFACE, NAME=hot\n"a, b", SPOS\n'),
                         {"hot": 1, "Surface1": 1})
        both = shells + "*SURFACE, NAME=up\n1, SPOS\n*SURFACE, NAME=down\n1, SNEG\n2, SNEG\n"
        self.assertEqual(self.surfaces(both), {"up": 1, "down": 2})
        self.assertIn("turned over where *SURFACE names their negative side (SNEG): down",
                      self.run_program("info", "a.inp").out)

    def test_the_negative_side_of_a_plate_faces_the_other_way(self):
        nodes = "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(
            [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], 1))
        self.put(f"*NODE\n{nodes}*ELEMENT, TYPE=S4\n1, 1,2,3,4\n2, 5,6,7,8\n"
                 "*SURFACE, NAME=low\n1, SPOS\n*SURFACE, NAME=high\n2, SNEG\n")
        self.run_program("factors", "a.inp", "--patches", "2", "--between", "groups", "-o", "t.json")
        # Unit squares face to face: Howell C-11.
        factors = json.loads((self.folder / "t.json").read_text())["form_factors"]
        self.assertAlmostEqual(factors[0][1], 0.199825, delta=1e-6)  # of its six digits

    def test_surfaces_of_an_assembly_have_sides_of_several_instances(self):
        part = ("*PART, NAME=p\n*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                "*ELEMENT, TYPE=C3D8, ELSET=body\n1, 1,2,3,4,5,6,7,8\n*SURFACE, NAME=foot\nbody, S1\n*END PART\n")
        text = part + ("*INSTANCE, NAME=a, PART=p\n*END INSTANCE\n*INSTANCE, NAME=b, PART=p\n3, 0, 0\n*END INSTANCE\n"
                       "*ELSET, ELSET=_g, INTERNAL, INSTANCE=a\n1\n*ELSET, ELSET=_h, INTERNAL, INSTANCE=b\n1\n"
                       "*SURFACE, NAME=gap\n_g, S4\n_h, S6\n*SURFACE, NAME=top\nb.body, S2\na.1, S2\n")
        self.assertEqual(self.surfaces(text), {"a.body": 3, "a.foot": 1, "b.body": 3, "b.foot": 1, "gap": 2, "top": 2})

    def test_volumes_of_every_order_give_their_skin(self):
        nodes = HEAD + "".join(f"{k}, {k % 5}, {k % 7}, {k % 3}\n" for k in range(11, 40))
        nodes += "7, 0., 0., 1.\n8, 1., 0., 1.\n9, 1., 1., 1.\n10, 0., 1., 1.\n"
        tetrahedron, brick = "1,2,4,7", "1,2,3,4,7,8,9,10"
        for kind, corners, count, area in [
                ("C3D4", tetrahedron, 4, 1.5 + 3 ** .5 / 2), ("C3D10M", tetrahedron, 10, 1.5 + 3 ** .5 / 2),
                ("c3d5", "1,2,3,4,7", 5, 2 + 2 ** .5), ("C3D6", "1,2,4,7,8,10", 6, 3 + 2 ** .5),
                ("DC3D15", "1,2,4,7,8,10", 15, 3 + 2 ** .5), ("C3D8I", brick, 8, 6), ("C3D20RBR", brick, 20, 6),
                ("AC3D20", brick, 20, 6)]:
            with self.subTest(kind=kind):
                more = [str(11 + k) for k in range(count - len(corners.split(",")))]
                lines = ",".join(corners.split(",") + more[:8]) + "".join(",\n" + x for x in more[8:])
                found = self.surfaces(f"{nodes}*ELEMENT, TYPE={kind}, ELSET=body\n1, {lines}\n")
                self.assertEqual(list(found), ["body"])
                self.assertAlmostEqual(found["body"], area, delta=1e-5)  # of digits in the report

    def test_generated_nodes_and_volumes_leave_the_shells_unchanged(self):
        # Nodes and volumes generated by keywords, a system that has ended, a set of volumes and shells.
        text = (HEAD + TWO + "*NGEN\n1, 5, 1\n*NFILL\nNall, Nall, 3\n*NCOPY\n*SYSTEM\n1, 0, 0\n*SYSTEM\n*NODE\n"
                "7, 0, 2, 0\n*ELEMENT, TYPE=C3D8, ELSET=Esolid\n3, 1,2,3,4,5,6,7,8\n*ELGEN\n3, 2, 1, 1\n"
                "*ELCOPY, OLD SET=Esolid\n*ELSET, ELSET=Eboth\nSurface1, Esolid\n")
        self.assertEqual(self.surfaces(text), {"Surface1": 2})

    def test_included_files_are_read(self):
        (self.folder / "parts").mkdir()
        self.put(HEAD + "*INCLUDE, INPUT=more.msh\n", "parts/nodes.inc")
        self.put(TWO, "parts/more.msh")
        text = "*INCLUDE, INPUT=parts/nodes.inc\n*ELSET, ELSET=left\n1\n"
        self.assertEqual(self.surfaces(text), {"left": 1, "Surface1": 1})
        self.put(TWO.replace("6,3", "9,3"), "parts/more.msh")
        self.assertEqual(self.refuse("info", self.put(text)), "radiosity: parts/more.msh:3: node 9 of element 2 "
                         "does not exist; correct it")
        self.says(":1: *INCLUDE of gone.inp: no such file; check the name and the folder",
                  "*INCLUDE, INPUT=gone.inp\n")
        self.says(":1: more than 16 files include one another; write them into one", "*INCLUDE, INPUT=a.inp\n")

    def test_nothing_of_another_file_is_quoted(self):
        self.put("root:x:0:0:root\n*secret\n", "secret.txt")
        line = self.refuse("info", self.put(HEAD + "*INCLUDE, INPUT=secret.txt\n"))
        self.assertEqual(line, "radiosity: secret.txt: begins with neither a keyword nor numbers, so it is no "
                         "input of CalculiX or Abaqus; correct the *INCLUDE")

    def test_broken_files_are_refused_by_line(self):
        text = HEAD + TWO
        for old, new, line in [
                ("2, 1., 0.", "2, 1., nan", ":6: coordinate `nan` is not a finite number; write it as 1.5 with a "
                                            "decimal point"),
                ("2, 1., 0.", "1, 1., 0.", ":6: node 1 is there twice; number nodes anew"),
                ("2, 1., 0.", "two, 1., 0.", ":6: node number `two` is not a whole number; correct it"),
                ("1, 1,2,3,4", "2, 1,2,3,4", ":13: element 2 is there twice; number elements anew"),
                ("1, 1,2,3,4", "1, 1,2,3,99999999999", ":12: node 99999999999 of element 1 does not exist; correct it"),
                ("1, 1,2,3,4", "1, 1,2,3,4,5", ":12: element 1 has 5 nodes, its type has 4; correct it"),
                ("2, 2,5,6,3\n", "2, 2,5,6\n", ":13: the last element has too few nodes; correct it, or the file is "
                                               "cut off"),
                ("2, 2,5,6,3\n", "2, 2,5,6\n*STEP\n", ":14: the element before it has too few nodes; correct it"),
                ("TYPE=S4, ", "", ":11: *ELEMENT names no type; add TYPE=S3 or another"),
                ("*HEADING\n", "*INSTANCE, NAME=a, PART=b\n", ":1: instance `a` is of part `b`, which does not come "
                                                              "before it; correct it"),
                ("*HEADING\n", "*PART, NAME=a\n*PART, NAME=b\n", ":2: a part begins within another; end that with "
                                                                  "*END PART"),
                ("*HEADING\n", "*PART, NAME=a\n*END PART\n*PART, NAME=A\n", ":3: part `A` is there twice; rename one"),
                ("*HEADING\n", "*PART, NAME=a\n*END PART\n*INSTANCE, PART=a, NAME=x\n*END INSTANCE\n*INSTANCE, PART=a, "
                 "NAME=X\n", ":5: instance `X` is there twice; rename one"),
                ("*HEADING\n", "*PART, NAME=a\n*END PART\n*INSTANCE, PART=a, NAME=x\n1, 2\n", ":4: an instance is placed "
                 "by a line of 3 numbers, its shift, and one of 7, two points of an axis and degrees; correct it"),
                ("*HEADING\n", "*PART, NAME=a\n*END PART\n*INSTANCE, PART=a, NAME=x\n0,0,0\n1,1,1,1,1,1,5\n",
                 ":5: the two points of the axis are the same; correct them"),
                ("*HEADING\n", "*PART, NAME=a\n", ": its parts have no *INSTANCE, so nothing says where they lie"),
                ("*HEADING\n", "*END INSTANCE\n", ":1: *END INSTANCE ends none; correct it"),
                ("*HEADING\n", "*ELSET, ELSET=s, INSTANCE=x\n", ":1: there is no instance `x` before it; correct it"),
                ("*HEADING\n", "*NMAP\n", ":1: *NMAP moves nodes and is not read; write nodes where they lie"),
                ("*HEADING\n", "*SYSTEM\n1, 0, 0\n", ":5: nodes in the coordinates of *SYSTEM are not read; write "
                                                      "x, y, z"),
                ("4, 0., 1., 0.", "*NGEN\n3, 4, 1", ":13: node 4 of element 1 does not exist; *ngen makes nodes and is "
                                                    "not read, write out nodes where they lie"),
                ("2, 2,5,6,3\n", "*ELGEN\n1, 3, 1, 1\n", ":13: *elgen makes elements of others and is not read; write "
                                                          "out nodes and elements where they lie"),
                ("2, 2,5,6,3\n", "*ELCOPY, OLD SET=surface1\n", ":13: *elcopy makes elements of others and is not "
                 "read; write out nodes and elements where they lie"),
                (", NSET=Nall", ", SYSTEM=C", ":4: cylindrical and spherical coordinates are not read; write x, y, z"),
                (", NSET=Nall", ", INPUT=x", ":4: *node from another file is not read; use *INCLUDE"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))
        self.says(":14: *ELSET names no set; add ELSET=NAME", text + "*ELSET\n1\n")
        self.says(":15: `none` is neither an element nor a set that came before; correct it",
                  text + "*ELSET, ELSET=a\nnone\n")
        self.says(":15: the last element is not less than the first, and the step is 1 or more; correct the line",
                  text + "*ELSET, ELSET=a, GENERATE\n1, 9, 0\n")
        self.says(": no faces, nodes alone; write the surfaces as shells (TYPE=S3, S4, S6, S8)", HEAD)
        lines = "*ELEMENT, TYPE=CAX8\n1, 1,2,3,4\n*ELEMENT, TYPE=B32\n2, 1,2,3\n*ELEMENT, TYPE=CAX8\n3, 1,2,3,4\n"
        self.says(": no faces, elements of type B32, CAX8 alone; write the surfaces as shells (TYPE=S3, S4, S6, S8)",
                  HEAD + lines)
        self.says(":13: element 2 has 5 nodes, its type has 4; correct it",
                  HEAD + "*ELEMENT, TYPE=C3D4\n1, 1,2,3,5\n2, 1,2,3,4,5\n")
        self.says(": is no input of CalculiX or Abaqus: it has neither *NODE nor *ELEMENT; check the name",
                  "SPECIES\nH2 O2\nEND\n")

    def test_sets_of_sets_do_not_fill_the_memory(self):
        text = HEAD + TWO + "*ELSET, ELSET=s0\n1, 1\n"
        for k in range(1, 60):
            text += f"*ELSET, ELSET=s{k}\ns{k - 1}, s{k - 1}\n"
        self.refuse("info", self.put(text), words=["element sets have more than 16777216 members"])
        self.surfaces(HEAD + TWO + "*ELSET, ELSET=s, GENERATE\n1, 9000000000000000000, 1\n")


if __name__ == "__main__":
    sys.exit(unittest.main())
