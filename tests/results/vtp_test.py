"""Patches for ParaView, read back by VTK's own reader and compared with the results file of the run."""
import sys
import unittest
from pathlib import Path

import h5py
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))
from cli_runner import SMALL, CliTest  # noqa: E402

# A two-sided sheet in an open box: backs, sky and names that are markup.
SHEET_OBJ = """mtllib box.mtl
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0.5 0.5 1
v 1.5 0.5 1
v 1.5 1.5 1
v 0.5 1.5 1
o floor & <"rug">
usemtl wall
f 1 2 3 4
o sheet
usemtl lamp
f 5 8 7 6
"""


class Read:
    """A file as VTK reads it: outlines, and arrays by name."""

    def __init__(self, path):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(path))
        reader.Update()
        data = reader.GetOutput()
        sizes = vtkCellSizeFilter()
        sizes.SetInputData(data)
        sizes.Update()
        self.areas = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Area"))
        self.points = vtk_to_numpy(data.GetPoints().GetData())
        polys = data.GetPolys()
        ends = vtk_to_numpy(polys.GetOffsetsArray())
        corners = vtk_to_numpy(polys.GetConnectivityArray())
        self.outlines = [corners[a:b] for a, b in zip(ends, ends[1:])]
        self.arrays = {}
        self.units = {}
        cells = data.GetCellData()
        for k in range(cells.GetNumberOfArrays()):
            array = cells.GetAbstractArray(k)
            if array.GetDataTypeAsString() == "string":
                self.arrays[array.GetName()] = [
                    array.GetValue(i) for i in range(array.GetNumberOfTuples())]
            else:
                self.arrays[array.GetName()] = vtk_to_numpy(array)
                self.units[array.GetName()] = array.GetInformation().Get(
                    vtkDataArray.UNITS_LABEL())
        names = data.GetFieldData().GetAbstractArray("surface_names")
        self.names = [names.GetValue(k) for k in range(names.GetNumberOfTuples())]


class Vtp(CliTest):
    def both(self, *arguments):
        """The .vtp and the .h5 of one run."""
        self.run_program(*arguments, "-o", "x.vtp", "-o", "x.h5")
        return Read(self.folder / "x.vtp"), h5py.File(self.folder / "x.h5")

    def check_geometry(self, read, mesh):
        numpy.testing.assert_array_equal(read.points, mesh["vertices"][()])
        ends = mesh["corner_offset"][()]
        corners = mesh["corners"][()]
        self.assertEqual(len(read.outlines), len(mesh["area"]))
        for k, outline in enumerate(read.outlines):
            numpy.testing.assert_array_equal(outline, corners[ends[k]:ends[k + 1]])
        names = [name.decode() for name in mesh["surface_names"][()]]
        surface = mesh["surface"][()]
        self.assertEqual(read.names, names)
        self.assertEqual(read.arrays["surface"], [names[s] for s in surface])
        # Area as VTK computes it of the polygons, but for rounding of coordinates' differences.
        numpy.testing.assert_allclose(read.areas, mesh["area"][()], rtol=1e-12)
        for name, wanted in [("surface_id", surface), ("area", mesh["area"][()]),
                             ("side", mesh["side"][()]), ("patch", range(len(surface)))]:
            numpy.testing.assert_array_equal(read.arrays[name], wanted)

    def check_fields(self, read, group, names):
        for name, dataset in names.items():
            numpy.testing.assert_array_equal(read.arrays[name], group[dataset][()], name)

    def test_a_file_of_solve_holds_mesh_rows_and_light_to_the_bit(self):
        read, h5 = self.both("solve", "box.obj", "--patches", 60, "--method", "exact")
        self.check_geometry(read, h5["mesh"])
        self.check_fields(read, h5["form_factors"],
                          {"row_sum": "fronts", "backs": "backs", "sky": "sky", "error": "error"})
        light = h5["solution"]
        self.check_fields(read, light, {name: name for name in
                                        ("radiosity", "irradiance", "reflectance", "emission")})
        net = light["radiosity"][()] - light["irradiance"][()]
        numpy.testing.assert_array_equal(read.arrays["net_flux"], net)
        # The net power of all patches of the room is 0.
        total = (read.arrays["area"][:, None] * net).sum(axis=0)
        emitted = (read.arrays["area"][:, None] * light["emission"][()]).sum(axis=0)
        # The solver's residual, and closure of the rows to the exact tolerance.
        self.assertLess(abs(total / emitted).max(), 1e-3)
        self.assertEqual(read.units["net_flux"], "W/m^2")
        self.assertEqual(read.units["area"], "m^2")
        self.assertIsNone(read.units["row_sum"])

    def test_backs_are_polygons_of_their_own_and_names_are_escaped(self):
        self.write("sheet.obj", SHEET_OBJ)
        read, h5 = self.both("factors", "sheet.obj", "--two-sided", "sheet", *SMALL)
        self.check_geometry(read, h5["mesh"])
        self.assertIn('floor & <"rug">/wall', read.names)
        self.assertEqual(set(read.arrays["side"]), {0, 1})
        self.check_fields(read, h5["form_factors"], {"backs": "backs", "sky": "sky"})
        self.assertNotIn("error", read.arrays)
        self.assertNotIn("radiosity", read.arrays)

    def test_a_file_of_mesh_holds_materials(self):
        read, h5 = self.both("mesh", "box.obj", "--patches", 60)
        self.check_geometry(read, h5["mesh"])
        lamp = numpy.array(read.arrays["surface"]) == "ceiling/lamp"
        self.assertTrue(lamp.any() and not lamp.all())
        numpy.testing.assert_allclose(read.arrays["reflectance"][lamp], [[.2, .2, .2]] * lamp.sum())
        numpy.testing.assert_allclose(read.arrays["emission"][lamp],
                                      [[5 * numpy.pi, 4 * numpy.pi, 3 * numpy.pi]] * lamp.sum())
        self.assertEqual(abs(read.arrays["emission"][~lamp]).max(), 0)
        self.assertNotIn("row_sum", read.arrays)


if __name__ == "__main__":
    unittest.main()
