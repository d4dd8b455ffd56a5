"""The README's commands for engineers, one by one, and whether the numbers are right."""
import csv
import os
import pathlib
import unittest

from cli_runner import CliTest

DATA = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"]) / "data"


class EngineerWalk(CliTest):
    def table(self, name):
        with open(self.folder / name, newline="") as file:
            return {row["name"]: row for row in csv.DictReader(file)}

    def test_a_city_gives_a_table_with_sky_view_factors(self):
        self.run_program("factors", DATA / "city.stl", "--between", "surfaces", "-o", "city.csv")
        city = self.table("city.csv")
        self.assertEqual(len(city), 7)
        for name, row in city.items():
            views = [float(row[other]) for other in [*city, "sky", "backs"]]
            # Each form factor is good to a thousandth of the mean, of some thousand patches.
            self.assertAlmostEqual(sum(views), 1, delta=1e-3, msg=name)
            for other in city:
                there = float(row["area_m2"]) * float(row[other])
                back = float(city[other]["area_m2"]) * float(city[other][name])
                self.assertAlmostEqual(there, back, delta=1e-9 * max(there, 1))
        # The tower, 6.1 times as high as it is wide, has 10 * 10 m^2 of roof, which sees the sky
        # alone, and 1,800 m^2 of walls, of whose view the sky is one half at least: above the roofs
        # around, half of the view is above the horizon, and below it there is ground or open land.
        sky = float(city["tower"]["sky"])
        self.assertGreater(sky, (100 + 0.5 * 0.9 * 1800) / 1900)
        self.assertLess(sky, 1)
        # Rays are independent of the exact method. Rows, whose norms are below .3, are good to
        # a tenth of that, and a surface has hundreds of them.
        self.run_program("factors", DATA / "city.stl", "--between", "surfaces", "--method", "rays",
                         "--tolerance", "0.1", "-o", "rays.csv")
        for name, row in self.table("rays.csv").items():
            self.assertAlmostEqual(float(row["sky"]), float(city[name]["sky"]), delta=1e-2)

    def test_nodes_sum_up_to_surfaces(self):
        for scene, patches in (("cornell-box-closed", "400"), ("furnished-room", "500")):
            self.run_program("factors", DATA / f"{scene}.obj", "--patches", patches, "--tolerance", "0.05",
                             "-o", "f.h5")
            self.run_program("factors", "f.h5", "--between", "60", "-o", "nodes.csv", "-o", "nodes.mtx")
            self.run_program("factors", "f.h5", "--between", "surfaces", "-o", "surfaces.csv")
            nodes, surfaces = self.table("nodes.csv"), self.table("surfaces.csv")
            self.assertLess(len(nodes), 1.2 * max(60, len(surfaces)))
            self.assertGreaterEqual(len(nodes), len(surfaces))
            surface_of = {name: name if name in surfaces else name.rsplit(" ", 1)[0] for name in nodes}
            self.assertEqual(set(surface_of.values()), set(surfaces))
            for name, row in nodes.items():
                # Sums in double precision of values in single precision.
                self.assertAlmostEqual(sum(float(row[other]) for other in [*nodes, "sky", "backs"]),
                                       float(row["sum"]), delta=1e-6)
                for other in nodes:
                    self.assertAlmostEqual(float(row["area_m2"]) * float(row[other]),
                                           float(nodes[other]["area_m2"]) * float(nodes[other][name]),
                                           delta=1e-9)
            exchange = dict.fromkeys(((a, b) for a in surfaces for b in surfaces), 0.0)
            for name, row in nodes.items():
                for other in nodes:
                    exchange[surface_of[name], surface_of[other]] += float(row["area_m2"]) * float(row[other])
            for (a, b), value in exchange.items():
                self.assertAlmostEqual(value, float(surfaces[a]["area_m2"]) * float(surfaces[a][b]), delta=1e-6)
            size = [line for line in (self.folder / "nodes.mtx").read_text().splitlines()
                    if not line.startswith("%")][0].split()
            self.assertEqual(size[:2], [str(len(nodes))] * 2)

    def test_a_number_of_nodes_that_is_none_is_refused(self):
        for value in ("0", "-3", "2.5", "1e9", "20000", "walls"):
            run = self.run_program("factors", DATA / "city.stl", f"--between={value}", code=2)
            self.assertIn("is not groups, surfaces, patches, or a number of nodes from 1 to 10000", run.err)

    def test_a_heater_by_name_gives_temperatures_that_vtk_reads(self):
        self.run_program("heat", DATA / "cornell-box-closed.obj", "--thermal", DATA / "oven.csv",
                         "-o", "oven.vtp", "-o", "oven.csv")
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / "oven.vtp"))
        reader.Update()
        temperature = reader.GetOutput().GetCellData().GetArray("temperature")
        low, high = temperature.GetRange()
        self.assertAlmostEqual(high, 900, delta=1e-9)  # the lamp is given, and nothing is hotter
        self.assertGreater(low, 290)  # of the air, which alone takes heat out
        with open(self.folder / "oven.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertIn("lamp/light", [row["surface"] for row in rows])

    def test_view3d_s_example_has_its_closed_form(self):
        self.run_program("factors", DATA / "quarter-blocked.vs3", "--between", "surfaces",
                         "-o", "blocked.vf", "-o", "blocked.csv")
        lines = (self.folder / "blocked.vf").read_text().splitlines()
        areas = [float(a) for a in lines[1].split()]
        for area, whole in zip(areas, [1, 1, 0.25], strict=True):
            self.assertAlmostEqual(area, whole, delta=1e-12)  # sums over some hundred patches
        lower = [float(f) for f in lines[2].split()]
        # Three fourths of two unit squares' (data/README.md), to the tolerance.
        self.assertAlmostEqual(lower[1], 0.149868671773790, delta=1e-4)
        table = self.table("blocked.csv")
        self.assertAlmostEqual(lower[1], float(table["lower"]["upper"]), delta=1e-6)


if __name__ == "__main__":
    unittest.main()
