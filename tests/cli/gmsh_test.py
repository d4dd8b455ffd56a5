"""Gmsh meshes as scenes: groups, element types, and each broken file with its exact line."""

import sys
import unittest

import mesh_files
from cli_runner import CliTest

MESH = mesh_files.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], {"plate": [[0, 1, 2, 3]]})


def nodes2(places):
    rows = "".join("{} {} {} {}\n".format(k + 1, *p) for k, p in enumerate(places))
    return f"$Nodes\n{len(places)}\n{rows}$EndNodes\n"


def msh2(places, elements, names=""):
    rows = "".join(f"{k + 1} {e}\n" for k, e in enumerate(elements))
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}{nodes2(places)}"
            f"$Elements\n{len(elements)}\n{rows}$EndElements\n")


SQUARE = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


class Gmsh(CliTest):
    def put(self, text, name="a.msh"):
        (self.folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return name

    def surfaces(self):
        return {s["name"]: [s["faces"], s["area_m2"]] for s in self.report("info", "a.msh")["scene"]["surfaces"]}

    def says(self, line, text):
        self.assertEqual(self.refuse("info", self.put(text)), "radiosity: a.msh" + line)

    def test_groups_without_names_and_faces_without_groups_have_numbers(self):
        self.put(msh2(SQUARE, ["2 2 5 8 1 2 3", "2 2 0 9 1 3 4", "3 2 6 8 1 2 3 4"],
                      '$PhysicalNames\n2\n1 5 "edge"\n2 6 "north wall"\n$EndPhysicalNames\n'))
        self.assertEqual(self.surfaces(), {"physical 5": [1, .5], "entity 9": [1, .5], "north wall": [1, 1]})

    def test_curved_elements_are_read_by_their_corners(self):
        places = SQUARE + [(.5, -.1, 0), (1.1, .5, 0), (.5, 1.1, 0), (-.1, .5, 0), (.5, .5, .1)]
        self.put(msh2(places, ["16 2 1 1 1 2 3 4 5 6 7 8", "10 2 2 2 1 2 3 4 5 6 7 8 9",
                               "9 2 3 3 1 2 3 5 6 9"]))
        self.assertEqual(list(self.surfaces().values()), [[1, 1], [1, 1], [1, .5]])
        self.assertIn("3 elements have nodes between their corners: they are read as flat, by their corners",
                      self.run_program("info", "a.msh").err)

    def test_volumes_lines_and_points_are_left_out(self):
        places = SQUARE + [(0, 0, 1)]
        self.put(msh2(places, ["15 2 0 1 1", "1 2 0 1 1 2", "2 2 1 1 1 2 3", "4 2 2 1 1 2 3 5",
                               "4 2 2 1 1 3 4 5"]))
        run = self.run_program("info", "a.msh")
        self.assertIn("2 volume elements are left out: their faces are no surfaces here", run.err)
        self.assertIn("2 lines and points have no area and are left out", run.out)
        self.says(": no faces; save the mesh of the surfaces too (in Gmsh: physical surfaces, or Mesh.SaveAll=1)",
                  msh2(places, ["1 2 2 1 1 2"]))

    def test_volumes_alone_are_read_by_their_skin(self):
        places = SQUARE + [(0, 0, 1)]
        names = '$PhysicalNames\n2\n2 2 "wall"\n3 2 "block"\n$EndPhysicalNames\n'
        # The second element appears once for each of its physical groups, as in version 2.2.
        self.put(msh2(places, ["4 2 2 1 1 2 3 5", "4 2 2 2 1 3 4 5", "4 2 7 2 1 3 4 5"], names))
        faces, area = self.surfaces()["block"]
        self.assertEqual(faces, 6)
        self.assertAlmostEqual(area, 2 + 2 ** .5, delta=1e-5)  # of digits in the report
        self.assertEqual(list(self.surfaces()), ["block"])
        self.assertRegex(self.run_program("info", "a.msh").out, r"watertight +yes")

    def test_a_face_in_several_groups_belongs_to_the_first(self):
        # Version 2.2 writes it once for each; 4.1 lists the groups of its entity.
        names = '$PhysicalNames\n2\n2 1 "a"\n2 2 "b"\n$EndPhysicalNames\n'
        self.put(msh2(SQUARE, ["3 2 1 8 1 2 3 4", "3 2 2 8 1 2 3 4"], names))
        self.assertEqual(self.surfaces(), {"a": [1, 1]})
        two = mesh_files.to_gmsh4(MESH).decode().replace("1.0 1 1 0", "1.0 2 1 2 0")
        self.put(two)
        self.assertEqual(self.surfaces(), {"plate": [1, 1]})
        self.assertIn("in several physical groups, they count to the first: faces also in: physical 2",
                      self.run_program("info", "a.msh").err)

    def test_groups_whose_faces_are_not_told_are_named(self):
        # As programs write 4.1 that keep names and know of no entities.
        text = mesh_files.to_gmsh4(MESH).decode()
        start, end = text.index("$Entities"), text.index("$EndEntities") + len("$EndEntities\n")
        self.put(text[:start] + text[end:])
        self.assertIn("no face is said to be in these physical groups (4.1 says so in $Entities; if there should be "
                      "some, save as 2.2): plate", self.run_program("info", "a.msh").err)

    def test_a_negative_group_turns_its_surface_over(self):
        below = mesh_files.Mesh(SQUARE + [(x, y, -1) for x, y, _ in SQUARE],
                                {"plate": [[0, 1, 2, 3]], "below": [[4, 5, 6, 7]]})
        for tag, sees in [(1, False), (-1, True)]:
            text = mesh_files.to_gmsh4(below).decode().replace("1.0 1 1 0", f"1.0 1 {tag} 0")
            self.put(text)
            report = self.report("factors", "a.msh", "--faces-as-patches", "-o", "f.mtx")
            self.assertEqual(list(self.surfaces()), ["plate", "below"])
            values = (self.folder / "f.mtx").read_text().splitlines()[-1].split()
            self.assertEqual(len(values) == 3 and float(values[2]) > 0.1, sees, report)

    def test_other_sections_are_skipped(self):
        text = msh2(SQUARE, ["3 2 1 8 1 2 3 4"])
        self.put(text + "$NodeData\n1\n\"T\"\n1\n0\n3\n0\n1\n1\n1 $Elements\n$EndNodeData\n")
        self.assertEqual(self.surfaces(), {"physical 1": [1, 1]})
        self.says(":15: section $NodeData has no end; the file is cut off, save it again",
                  text + "$NodeData\n1\n")

    def test_broken_text_is_refused_by_line(self):
        text = mesh_files.to_gmsh4(MESH).decode()
        old = msh2(SQUARE, ["3 2 1 8 1 2 3 4"])
        for whole, piece, new, line in [
                (text, "$MeshFormat\n4.1", "$MeshFormat\n4.0", ":2: MSH version 4.0 is not read; save as 4.1 or "
                 "2.2 (in Gmsh: -format msh41)"),
                (text, "$MeshFormat\n", "", ":1: is no Gmsh mesh, which begins with $MeshFormat; save it as .msh"),
                (old, "2 1 0 0\n", "2 nan 0 0\n", ":7: coordinate `nan` is not a finite number; write it as 1.5 "
                 "with a decimal point"),
                (old, "2 1 0 0\n", "1 1 0 0\n", ":7: node 1 is there twice; number nodes anew"),
                (old, "8 1 2 3 4", "8 1 2 3 9", ":13: node 9 does not exist; correct the element or save the "
                 "mesh again"),
                (old, "1 3 2 1 8", "1 77 2 1 8", ":13: elements of type 77 are not read; save the mesh with "
                 "elements of the first order"),
                (old, "$Nodes\n4\n", "$Nodes\n4000000000\n", ":5: number of nodes 4000000000: the file is too "
                 "short for so many; it is cut off or damaged, export it again"),
                (old, "$Nodes\n4\n", "$Nodes\n-4\n", ":5: number of nodes -4: it cannot be negative; correct it"),
                (old, "$Nodes\n4\n", "$Nodes\n3\n", ":9: `4 0 1 0` stands where $EndNodes belongs; save the mesh "
                 "again"),
                (old, "3 2 1 8 1", "3 -2 1 8 1", ":13: number of tags -2: it cannot be negative; correct it"),
        ]:
            with self.subTest(new=new):
                self.assertIn(piece, whole)
                self.says(line, whole.replace(piece, new))

    def test_other_formats_of_this_extension_are_named(self):
        for text in ("$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n", "$PARA\n$ENDPARA\n"):
            self.say_format(text, "is a Gmsh mesh of format 1, which is not read; convert it to 4.1: gmsh "
                                  "'a.msh' -save -format msh41 -o NEW.msh")
        self.say_format('(0 "GAMBIT to Fluent")\n(2 3)\n', "is a mesh of Fluent, not of Gmsh")

    def say_format(self, text, words):
        self.put(text)
        self.refuse("info", "a.msh", words=["a.msh: " + words])

    def test_broken_binary_is_refused_by_byte(self):
        for whole in [mesh_files.to_gmsh2(MESH, binary=True), mesh_files.to_gmsh4(MESH, binary=True)]:
            self.put(whole)
            self.assertEqual(self.surfaces(), {"plate": [1, 1]})
            for old, new in [(b"\x01\0\0\0\n$EndMesh", b"\x02\0\0\0\n$EndMesh"),
                             (b"$Elements\n", b"$Elements\n9999")]:
                with self.subTest(new=new):
                    self.put(whole.replace(old, new))
                    self.refuse("info", "a.msh", words=["a.msh: byte "])


if __name__ == "__main__":
    sys.exit(unittest.main())
