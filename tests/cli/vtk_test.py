"""VTK files as scenes, legacy and XML: cells of every kind, groups, and each broken file with its line."""

import base64
import lzma
import re
import struct
import subprocess
import sys
import unittest
import zlib

from vtkmodules.vtkCommonCore import vtkIntArray
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import mesh_files
from cli_runner import PROGRAM, CliTest, limit

MESH = mesh_files.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], {"plate": [[0, 1, 2], [0, 2, 3]]})
POINTS = "POINTS 6 float\n0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0\n"
LEGACY = "# vtk DataFile Version 3.0\n\nASCII\nDATASET "


class Vtk(CliTest):
    def put(self, content, name="a.vtk"):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def areas(self, name="a.vtk"):
        return {s["name"]: s["area_m2"] for s in self.report("info", name)["scene"]["surfaces"]}

    def says(self, line, content, name="a.vtk"):
        self.assertEqual(self.refuse("info", self.put(content, name)), f"radiosity: {name}{line}")

    def test_arrays_unpack_to_no_more_than_their_piece_declares(self):
        """A megabyte for three points, in a file of some kilobytes; ratios alone allow it."""
        raw = bytes(1 << 20)
        pack = {"vtkZLibDataCompressor": zlib.compress, "vtkLZMADataCompressor": lzma.compress,
                # A run of zeros: a literal, then a match whose length is 4 + 15 + 255 + 255 ...; 5 literals end it.
                "vtkLZ4DataCompressor": lambda raw: b"\x1f\0\1\0" + b"\xff" * ((len(raw) - 25) // 255)
                + bytes([(len(raw) - 25) % 255]) + b"\x50" + bytes(5)}

        def array(kind, name, count):
            data = packed(count * {"Float32": 4, "Int32": 4, "UInt8": 1}[kind] if name != bomb else len(raw))
            return f'<DataArray type="{kind}" Name="{name}" format="binary">{data}</DataArray>'

        def packed(size):
            body = pack[compressor](raw[:size]) if size > 99 or "LZ4" not in compressor else \
                bytes([size << 4] if size < 15 else [0xf0, size - 15]) + raw[:size]
            head = struct.pack("<4I", 1, size, 0, len(body))
            return base64.b64encode(head).decode() + base64.b64encode(body).decode()
        for compressor in pack:
            for bomb, values in [("Points", 9), ("offsets", 1), ("connectivity", 0), ("types", 1)]:
                with self.subTest(compressor=compressor, bomb=bomb):
                    text = (f'<VTKFile type="UnstructuredGrid" byte_order="LittleEndian" compressor="{compressor}">'
                            '<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1">'
                            f'<Points>{array("Float32", "Points", 9)}</Points><Cells>'
                            f'{array("Int32", "connectivity", 0)}{array("Int32", "offsets", 1)}'
                            f'{array("UInt8", "types", 1)}</Cells></Piece></UnstructuredGrid></VTKFile>')
                    self.assertLess(len(text), 15000)
                    self.says(f": DataArray {bomb}: it unpacks to more than the {values} values that its piece has; "
                              "the file is damaged, export it again", text, "a.vtu")

    def test_strips_and_polygons_take_their_cell_data(self):
        self.put(LEGACY + "POLYDATA\n" + POINTS + "LINES 1 3\n2 0 1\nTRIANGLE_STRIPS 1 7\n6 0 1 2 3 4 5\n"
                 "POLYGONS 1 7\n6 0 1 3 5 4 2\nCELL_DATA 3\nSCALARS Region int\nLOOKUP_TABLE default\n9 1 2\n")
        # Cell data stand in the order lines, polygons, strips, whatever the order in the file.
        self.assertEqual(self.areas(), {"Region 1": 2, "Region 2": 2})
        # All four triangles of the strip face as the polygon does: a lamp of 1 W/m^2 above sees both.
        scene = self.report("info", "a.vtk")["scene"]
        self.assertEqual([s["faces"] for s in scene["surfaces"]], [1, 4])
        self.assertNotIn("flipped", self.run_program("info", "a.vtk").err)

    def test_pixels_and_curved_cells_are_read(self):
        cells = "4 0 1 2 3\n6 0 1 3 4 5 2\n4 2 3 4 5\n4 0 1 2 4\n2 0 1\n"
        self.put(LEGACY + "UNSTRUCTURED_GRID\n" + POINTS + f"CELLS 5 25\n{cells}CELL_TYPES 5\n8 22 8 10 3\n")
        self.assertEqual(self.areas(), {"a": 2.5})
        run = self.run_program("info", "a.vtk")
        for words in ["1 element has nodes between its corners: it is read as flat, by its corners",
                      "1 volume element is left out: its faces are no surfaces here"]:
            self.assertIn(words, run.err)

    def test_volumes_alone_are_read_by_their_skin(self):
        points = "POINTS 12 float\n" + "".join(f"{x} {y} {z}\n" for z in range(3) for y in range(2) for x in range(2))
        # A voxel counts its points row by row, a hexahedron around.
        cells = "8 0 1 2 3 4 5 6 7\n8 4 5 7 6 8 9 11 10\n"
        self.put(LEGACY + "UNSTRUCTURED_GRID\n" + points + f"CELLS 2 18\n{cells}CELL_TYPES 2\n11 12\n")
        self.assertEqual(self.areas(), {"a": 10})
        run = self.run_program("info", "a.vtk")
        self.assertIn("no faces, volume elements alone (2)", run.err)
        self.assertRegex(run.out, r"watertight +yes")
        self.says(": cell 0: a volume of 5 points has too few; correct or remove it",
                  LEGACY + "UNSTRUCTURED_GRID\n" + points + "CELLS 1 6\n5 0 1 2 3 4\nCELL_TYPES 1\n12\n")
        self.says(": no faces, volume elements alone; export the surface as polygons",
                  LEGACY + "UNSTRUCTURED_GRID\n" + points + "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n15\n")

    def test_arrays_that_are_no_groups_are_skipped(self):
        data = ("POINT_DATA 6\nSCALARS group int 1\nLOOKUP_TABLE own\n1 2 3 4 5 6\nLOOKUP_TABLE own 1\n0 0 0 1\n"
                "NORMALS n float\n" + "0 0 1 " * 6 + "\nCELL_DATA 2\nFIELD FieldData 4\ntemperature 1 2 float\n300 nan\n"
                "METADATA\nINFORMATION 0\n\ngroup 2 2 int\n1 2 3 4\ngroup 1 2 float\n.1 .2\n"
                "part%20name 1 2 string\nnorth%20wall\nlamp\n")
        self.put(LEGACY + "POLYDATA\n" + POINTS + "POLYGONS 2 10\n4 0 1 3 2\n4 2 3 5 4\n" + data)
        self.assertEqual(self.areas(), {"north wall": 1, "lamp": 1})

    def test_words_name_groups_in_xml(self):
        text = mesh_files.to_vtk_xml(MESH).decode()
        codes = " ".join(str(b) for name in ["floor", ""] for b in name.encode() + b"\0")
        text = re.sub(r'<DataArray type="Int32" Name="group".*?</DataArray>',
                      f'<DataArray type="String" Name="Names of parts" format="ascii">1</DataArray>'
                      f'<DataArray type="String" Name="PartName" format="ascii">{codes}</DataArray>', text)
        self.put(text, "a.vtp")
        self.assertEqual(self.areas("a.vtp"), {"floor": .5, "unnamed": .5})

    def test_the_best_of_several_group_arrays_names_the_surfaces(self):
        number = "{} 1 2 int\n{}\n"
        words = "part 1 2 string\nlamp\nfloor\n"
        ids = number.format("CellEntityIds", "4 4")
        cells = number.format("patch", "0 1")
        surface = number.format("surface", "7 7")
        for arrays, names in [([ids, surface, words], ["lamp", "floor"]), ([ids, surface], ["surface 7"]),
                              ([surface, ids], ["surface 7"]), ([cells, ids], ["CellEntityIds 4"]),
                              ([cells], ["patch 0", "patch 1"]),
                              ([cells, number.format("object", "8 9")], ["object 8", "object 9"])]:
            self.put(LEGACY + "POLYDATA\n" + POINTS + "POLYGONS 2 10\n4 0 1 3 2\n4 2 3 5 4\nCELL_DATA 2\n"
                     f"FIELD FieldData {len(arrays)}\n" + "".join(arrays))
            self.assertEqual(list(self.areas()), names)

    def test_all_pieces_have_the_same_array(self):
        # Each piece has one cell, so that its number is the only one there.
        number = '<DataArray type="Int32" Name="{}" format="ascii">{}</DataArray>'
        pieces = ""
        for k in range(3):
            pieces += ('<Piece NumberOfPoints="3" NumberOfPolys="1"><Points><DataArray type="Float64" '
                       f'NumberOfComponents="3" format="ascii">{k} 0 0 {k + 1} 0 0 {k} 1 0</DataArray></Points><CellData>'
                       f'{number.format("region", k)}{number.format("zone", k // 2)}</CellData><Polys>'
                       f'{number.format("connectivity", "0 1 2")}{number.format("offsets", 3)}</Polys></Piece>')
        self.put(f'<VTKFile type="PolyData"><PolyData>{pieces}</PolyData></VTKFile>', "a.vtp")
        self.assertEqual(self.areas("a.vtp"), {"zone 0": 1, "zone 1": .5})

    def test_the_programs_own_files_keep_the_names(self):
        box = self.areas("box.obj")
        self.run_program("mesh", "box.obj", "--patches", "60", "-o", "a.vtp")
        again = self.areas("a.vtp")
        self.assertEqual(sorted(again), sorted(box))
        for name, area in again.items():
            self.assertAlmostEqual(area, box[name], 12)

    def written_by_vtk(self, compressor, mode):
        """A grid of 60 x 60 squares, so that it takes more than one block; half of them are group 1."""
        plane = vtkPlaneSource()
        plane.SetResolution(60, 60)
        plane.Update()
        grid = plane.GetOutput()
        group = vtkIntArray()
        group.SetName("group")
        for k in range(grid.GetNumberOfCells()):
            group.InsertNextValue(int(2 * k >= grid.GetNumberOfCells()))
        grid.GetCellData().AddArray(group)
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(str(self.folder / "a.vtp"))
        getattr(writer, f"SetCompressorTypeTo{compressor}")()
        getattr(writer, f"SetDataModeTo{mode}")()
        writer.SetInputData(grid)
        self.assertTrue(writer.Write())

    def test_files_written_by_vtk_are_read(self):
        for compressor in ["None", "ZLib", "LZ4", "LZMA"]:
            for mode in ["Binary", "Appended"]:
                with self.subTest(f"{compressor} {mode}"):
                    self.written_by_vtk(compressor, mode)
                    packed = f"vtk{compressor}DataCompressor".encode()
                    self.assertEqual(packed in (self.folder / "a.vtp").read_bytes(), compressor != "None")
                    areas = self.areas("a.vtp")
                    self.assertEqual(list(areas), ["group 0", "group 1"])
                    for area in areas.values():
                        self.assertAlmostEqual(area, 0.5, 6)  # single precision

    def test_damaged_packed_data_are_read_or_refused(self):
        for compressor in ["LZ4", "LZMA"]:
            self.written_by_vtk(compressor, "Appended")
            content = bytearray((self.folder / "a.vtp").read_bytes())
            begin = content.index(b"<AppendedData")
            refused = 0
            for at in range(begin + 40, len(content) - 60, (len(content) - begin) // 40):
                broken = content[:]
                broken[at] = ord("A") if broken[at] != ord("A") else ord("Q")
                run = self.attempt(bytes(broken))
                self.assertIn(run.returncode, (0, 2), run.stderr)
                refused += run.returncode == 2
                self.assertLessEqual(run.stderr.count("radiosity: a.vtp"), 1)
            self.assertGreater(refused, 0)

    def attempt(self, content):
        self.put(content, "a.vtp")
        return subprocess.run([PROGRAM, "info", "a.vtp"], cwd=self.folder, capture_output=True, text=True,
                              timeout=limit(60),
                              check=False)

    def test_broken_legacy_files_are_refused_by_line(self):
        text = LEGACY + "POLYDATA\n" + POINTS + "POLYGONS 1 4\n3 0 1 2\n"
        for old, new, line in [
                ("# vtk", "# vkt", ":1: is no VTK file, which begins with `# vtk DataFile Version`; export it again"),
                ("ASCII", "UTF-8", ":3: the third line is ASCII or BINARY; export the file again"),
                ("POLYDATA", "STRUCTURED_GRID", ":4: DATASET structured_grid is not read; save its surface as POLYDATA "
                                                "(in ParaView: Extract Surface)"),
                ("POINTS 6", "POINTS 60000", ":6: number of points 60000: the file is too short for so many; it is cut "
                                             "off or damaged, export it again"),
                ("0 0 0 1", "0 0 nan 1", ":6: coordinate `nan` is not a finite number; write it as 1.5 with a decimal "
                                         "point"),
                ("3 0 1 2", "3 0 1 6", ": cell 0: point 6 does not exist, there are 6 (from 0); correct it"),
                ("3 0 1 2", "3 0 1 -2", ": cell 0: point -2 does not exist, there are 6 (from 0); correct it"),
                ("3 0 1 2", "4 0 1 2", ":8: cell 0 goes beyond the size of its list; export the file again"),
                ("3 0 1 2", "2 0 1 2", ": cell 0: a face of 2 points has too few; correct or remove it"),
                ("POLYGONS", "POLYGON", ":7: `polygon` is no part of a VTK file that is read; export it again"),
                ("float", "half", ":5: numbers of type `half` are not read; save as ASCII"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new))
        self.says(": cells have no CELL_TYPES; export it again",
                  text.replace("POLYDATA", "UNSTRUCTURED_GRID").replace("POLYGONS", "CELLS"))
        self.says(": cell 0: cells of type 99 are not read; export polygons",
                  text.replace("POLYDATA", "UNSTRUCTURED_GRID").replace("POLYGONS", "CELLS") + "CELL_TYPES 1\n99\n")

    def test_broken_xml_files_are_refused_by_element(self):
        text = mesh_files.to_vtk_xml(MESH).decode()
        for old, new, line in [
                ("</Polys>", "", ": is no sound XML (byte 637: Start-end tags mismatch); export it again"),
                ("VTKFile", "VTK", ": has no element VTKFile; export it again"),
                ("PolyData", "ImageData", ": type `ImageData` is not read; save its surface as PolyData (in ParaView: "
                                          "Extract Surface)"),
                ('"offsets"', '"ends"', ": Polys has no DataArray offsets; export it again"),
                (">3 6<", ">3 7<", ": Polys: offset 7 goes beyond its points; export it again"),
                (">3 6<", ">3 2<", ": cell 1: its points end before they begin, or beyond the last; export the file "
                                   "again"),
                (">0 1 2 0 2 3<", ">0 1 2 0 2 4<", ": cell 1: point 4 does not exist, there are 4 (from 0); correct it"),
                (">0.0 ", ">nan ", ": DataArray Points:1: coordinate `nan` is not a finite number; write it as 1.5 with "
                                   "a decimal point"),
                (">1 1<", ">1<", ": DataArray group has 1 values for 2 cells; export it again"),
                ("Float64", "Float80", ": DataArray Points: type `Float80` is not read; export the file again"),
                ('byte_order', 'compressor="vtkSnappyDataCompressor" byte_order', ": compressor vtkSnappyDataCompressor is not "
                 "read; save with zlib or without one"),
        ]:
            with self.subTest(new=new):
                self.assertIn(old, text)
                self.says(line, text.replace(old, new), "a.vtp")

    def test_broken_coded_data_are_refused(self):
        packed = mesh_files.to_vtk_xml(MESH, form="binary", compressed=True).decode()
        plain = mesh_files.to_vtk_xml(MESH, form="binary").decode()
        raw = mesh_files.to_vtk_xml(MESH, form="appended", encoding="raw")
        first = re.search(r'format="binary">\s*(\S+)', plain).group(1)
        cases = [(plain.replace(first, "!" + first[1:]), "its base64 is damaged"),
                 (plain.replace(first, first[:-8]), "it ends too early"),
                 (plain.replace(first, "////////" + first[8:]), "it ends too early"),
                 (raw.replace(b'offset="0"', b'offset="99999"'), "its offset is beyond the appended data"),
                 (raw.replace(b"</AppendedData>", b""), "its appended data is cut off")]
        # In order: number of blocks, their size, that of the last one, the packed size.
        first = re.search(r'format="binary">\s*(\S+)', packed).group(1)
        for numbers, words in [((2**60, 1000, 96, 40), "it has too many blocks"),
                               ((1, 1000, 2**50, 40), "a block's size is wrong"),
                               ((1, 1000, 96, 2**50), "a block's size is wrong"),
                               ((1, 1000, 97, 12), "it unpacks to more than the 12 values that its piece has"),
                               ((1, 1000, 95, 12), "a block cannot be unpacked")]:
            head = base64.b64encode(struct.pack("<4Q", *numbers)).decode()
            cases.append((packed.replace(first, head + first[len(head):]), words))
        for content, words in cases:
            with self.subTest(words=words):
                self.refuse("info", self.put(content, "a.vtp"), words=["a.vtp: ", words])


if __name__ == "__main__":
    sys.exit(unittest.main())
