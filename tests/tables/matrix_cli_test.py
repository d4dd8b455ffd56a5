"""Form factors as files: compared with each other, and solved without their scene."""
import csv
import os
import sys
import unittest
from pathlib import Path

import h5py
import numpy
import scipy.io

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))
from cli_runner import CliTest  # noqa: E402

BOX = ["box.obj", "--patches", 60, "--method", "exact"]

# Two plates that see only each other: B1 = E1 + r1 B2, B2 = r2 B1.
PLATES = "%%MatrixMarket matrix coordinate real general\n2 2 2\n1 2 1\n2 1 1\n"


class Matrices(CliTest):
    def light(self, name):
        with (self.folder / name).open(newline="") as file:
            return list(csv.DictReader(file))

    def test_matrices_of_one_run_are_the_same_in_every_file(self):
        self.run_program("factors", *BOX, "--between", "patches", "-o", "f.h5", "-o", "f.mtx", "-o",
                         "f.vf")
        for a, b in [("f.h5", "f.mtx"), ("f.mtx", "f.vf"), ("f.vf", "f.h5")]:
            c = self.report("compare", a, b, "--tolerance", "1e-6")["comparison"]
            # The far side of a pair is rounded to 32 bits in the .mtx.
            self.assertLess(c["relative_l2"], 6e-8)
            self.assertLess(c["reciprocity_a"], 6e-8)
            self.assertEqual(c["area_difference"], 0)
            self.assertAlmostEqual(c["row_sum_a"], 1, delta=1e-6)
        read = scipy.io.mmread(self.folder / "f.mtx").toarray()
        with h5py.File(self.folder / "f.h5") as file:
            self.assertEqual(numpy.count_nonzero(read), len(file["form_factors/data"]))

    def test_the_largest_difference_is_named(self):
        self.run_program("factors", *BOX, "-o", "f.mtx")
        lines = (self.folder / "f.mtx").read_text().splitlines()
        row, column, value = lines[-1].split()
        lines[-1] = f"{row} {column} {float(value) + 0.5}"
        self.write("g.mtx", "\n".join(lines) + "\n")
        c = self.report("compare", "f.mtx", "g.mtx", "--tolerance", "1e-3", code=1)["comparison"]
        self.assertAlmostEqual(c["largest"], 0.5)
        name = next(line.split("name ")[1] for line in lines if line.startswith(f"% row {row} "))
        self.assertEqual(c["largest_from"], f"row {row} ({name})")
        self.assertEqual(c["rows_by_name"][0]["name"], name)
        self.assertEqual(c["verdict"], "above the tolerance of 0.001")

    def test_results_files_are_compared_by_form_factors_on_request(self):
        self.run_program("solve", *BOX, "-o", "a.h5")
        self.run_program("solve", *BOX, "--tolerance", "1e-2", "-o", "b.h5")
        report = self.report("compare", "a.h5", "b.h5", "--form-factors")
        self.assertIn("reciprocity_a", report["comparison"])
        self.assertNotIn("reciprocity_a", self.report("compare", "a.h5", "b.h5")["comparison"])

    def test_a_matrix_from_elsewhere_is_solved(self):
        self.write("plates.mtx", PLATES)
        self.write("areas.txt", "2\n2\n")
        self.write("rows.csv", "row,reflectance,emission\n1,.5,3\n2,.8,0\n")
        report = self.report("solve", "plates.mtx", "--areas", "areas.txt", "--rows", "rows.csv",
                             "--solve-tolerance", "1e-12", "-o", "light.csv")
        first, second = self.light("light.csv")
        b1 = 3 / (1 - .5 * .8)
        # The residual of 1e-12 times 3 W/m^2, over 1 - rho.
        self.assertAlmostEqual(float(first["radiosity_W_per_m2"]), b1, delta=1e-11)
        self.assertAlmostEqual(float(second["radiosity_W_per_m2"]), .8 * b1, delta=1e-11)
        self.assertAlmostEqual(float(first["irradiance_W_per_m2"]), .8 * b1, delta=1e-11)
        self.assertAlmostEqual(float(second["net_flux_W_per_m2"]), -.2 * b1, delta=1e-11)
        self.assertEqual(first["area_m2"], "2")
        self.assertAlmostEqual(report["solution"]["emitted_W"][0], 6)

    def test_areas_that_break_reciprocity_are_warned_of(self):
        self.write("plates.mtx", PLATES)
        self.write("rows.csv", "row,reflectance,emission\n1,.5,3\n2,.8,0\n")
        for areas, warned in (("2\n2\n", False), ("2\n4\n", True)):
            self.write("areas.txt", areas)
            run = self.run_program("solve", "plates.mtx", "--areas", "areas.txt", "--rows",
                                   "rows.csv")
            self.assertEqual("A_i F_ij and A_j F_ji differ by" in run.err, warned)

    def test_a_closed_matrix_that_absorbs_nothing_writes_no_light(self):
        self.write("plates.mtx", PLATES)
        self.write("rows.csv", "row,reflectance,emission\n1,1,3\n2,1,0\n")
        run = self.run_program("solve", "plates.mtx", "--rows", "rows.csv", "-o", "light.csv",
                               code=1)
        self.assertIn("singular", run.err + run.out)
        self.assertNotIn("light.csv", self.files())

    def test_light_of_the_matrix_is_that_of_the_scene(self):
        self.run_program("solve", *BOX, "--solve-tolerance", "1e-10", "-o", "s.csv", "-o", "s.h5",
                         "-o", "s.mtx")
        pi = numpy.pi
        self.write("rows.csv", "name,reflectance_1,reflectance_2,reflectance_3,"
                   "emission_1,emission_2,emission_3\n"
                   f"ceiling/lamp,.2,.2,.2,{5 * pi},{4 * pi},{3 * pi}\n*,.5,.6,.7,0,0,0\n")
        self.run_program("solve", "s.mtx", "--rows", "rows.csv", "--solve-tolerance", "1e-10", "-o",
                         "m.csv")
        columns = [f"{q}_{b}_W_per_m2" for q in ("radiosity", "irradiance", "net_flux") for b in (1, 2, 3)]
        of_scene, of_matrix = [numpy.array([[float(row[c]) for c in columns] for row in
                                            self.light(name)]) for name in ("s.csv", "m.csv")]
        # Values are rounded to 32 bits in the .mtx; radiosities are up to 20 W/m^2.
        numpy.testing.assert_allclose(of_matrix, of_scene, atol=2e-6)
        with h5py.File(self.folder / "s.h5") as file:
            numpy.testing.assert_array_equal(of_scene[:, :3], file["solution/radiosity"][()])

    # Four surfaces, two of them adiabatic: Howell, Menguc & Siegel's enclosure; F by row, each
    # divided by its sum; areas by reciprocity.
    def enclosure(self):
        f = numpy.array([[0, .123, .6928, .1841], [.123, 0, .1841, .6928],
                         [.2771, .0736, .4458, .2035], [.0736, .2771, .2035, .4458]])
        return f / f.sum(axis=1, keepdims=True)

    def assert_enclosure(self, name):
        rows = self.light(name)
        temperature = [float(row["temperature_K"]) for row in rows]
        self.assertAlmostEqual(temperature[2], 505.52788, delta=1e-5)
        self.assertAlmostEqual(temperature[3], 463.29647, delta=1e-5)
        # The published flux has sigma = 5.670367e-8.
        flux = float(rows[0]["net_flux_W_per_m2"]) * 5.670367e-8 / 5.67037441918443e-8
        self.assertAlmostEqual(flux, 2003.1839, delta=1e-4)

    def test_heat_of_an_enclosure_of_view3d(self):
        lines = ["View3D 3.3.1 0 1 0 4", "1 1 2.5 2.5"]
        lines += [" ".join(map(repr, map(float, row))) for row in self.enclosure()]
        self.write("f.vf", "\n".join([*lines, "1 .75 .5 .5"]) + "\n")
        conditions = ["--condition", "1.temperature=550", "--condition", "2.temperature=300",
                      "--condition", "*.flux=0"]
        run = self.run_program("heat", "f.vf", *conditions, "-o", "s.csv", "--patch-table", "r.csv")
        self.assert_enclosure("r.csv")
        self.assertEqual([row["surface"] for row in self.light("s.csv")],
                         ["row 1", "row 2", "row 3", "row 4"])
        self.assertEqual(run.err, "")
        self.assertIn("row sums from", self.run_program("info", "f.vf").out)

    def test_heat_of_a_matrix_with_names(self):
        f = self.enclosure()
        names = ["bottom", "top", "left", "right"]
        text = "%%MatrixMarket matrix array real general\n"
        for i, (area, name) in enumerate(zip([1, 1, 2.5, 2.5], names)):
            text += f"% row {i + 1} area {area} sky 0 backs 0 name {name}\n"
        text += "4 4\n" + "".join(f"{float(x)!r}\n" for x in f.T.ravel())
        self.write("f.mtx", text)
        self.write("t.csv", "surface,emissivity,temperature_K,flux_W_per_m2\nbottom,1,550,\n"
                   "top,.75,300,\n*,.5,,0\n")
        self.run_program("heat", "f.mtx", "--thermal", "t.csv", "-o", "s.csv", "--patch-table",
                         "r.csv")
        self.assert_enclosure("r.csv")
        self.assertEqual([row["surface"] for row in self.light("s.csv")], names)
        heat = ["heat", "f.mtx", "--thermal", "t.csv"]
        self.refuse(*heat, "-o", "x.h5", words=["x.h5", ".csv"])
        self.refuse(*heat, "--patches", 9, words=["--patches", "is a matrix"])
        self.refuse(*heat, "--condition", "botom.flux=1", words=["botom", "there are: bottom"])
        self.refuse("heat", "f.mtx", words=["no conditions are given"])
        self.refuse("heat", "f.mtx", "--condition", "*.flux=0", words=["no emissivity for row 1 (bottom)"])
        self.refuse("heat", "box.obj", "--areas", "t.csv", "--condition", "*.flux=0",
                    words=["--areas", "box.obj"])

    def test_a_matrix_is_no_scene(self):
        self.write("plates.mtx", PLATES)
        said = self.run_program("info", "plates.mtx").out
        for words in ("2 rows", "--rows", "--thermal", "compare"):
            self.assertIn(words, said)
        self.refuse("mesh", "plates.mtx", words=["plates.mtx", "form factors alone", "mesh needs a scene"])
        self.refuse("render", "none.mtx", "-o", "x.png", words=["none.mtx", "no such file"])

    def test_unusable_matrix_files_are_named(self):
        self.write("rows.csv", "row,reflectance,emission\n1,.5,3\n2,.8,0\n")
        self.write("q.mtx", "2 2 2\n1 2 1\n2 1 1\n")
        self.write("q.vf", "text\n")
        os.mkfifo(self.folder / "pipe.mtx")
        for command in (["solve", "--rows", "rows.csv"], ["heat", "--condition", "*.flux=0"],
                        ["info"], ["compare", "q.mtx"]):
            for name, words in (("q.mtx", "does not begin with %%MatrixMarket"),
                                ("q.vf", "does not begin as View3D's"), ("pipe.mtx", "is a pipe"),
                                ("none.mtx", "no such file")):
                if command[0] == "compare" and name != "q.mtx":
                    continue
                self.refuse(command[0], name, *command[1:], words=[name, words])
        self.write("q.mtx", "%%MatrixMarket matrix coordinate real general\n"
                   "999999999999 999999999999 1\n1 1 1\n")
        self.refuse("solve", "q.mtx", "--rows", "rows.csv",
                    words=["q.mtx:2", "999999999999 rows", "form factors have 1 to"])

    def test_options_that_do_not_fit_a_matrix_are_refused(self):
        self.write("plates.mtx", PLATES)
        self.write("rows.csv", "row,reflectance,emission\n1,.5,3\n2,.8,0\n")
        self.run_program("factors", *BOX, "-o", "f.h5")
        solve = ["solve", "plates.mtx", "--rows", "rows.csv"]
        self.refuse("solve", "plates.mtx", words=["plates.mtx", "--rows"])
        self.refuse(*solve, "-o", "x.h5", words=["x.h5", ".csv"])
        self.refuse(*solve, "--patches", 9, words=["--patches", "is a matrix"])
        self.refuse(*solve, "--unit", "mm", words=["--unit", "is a matrix"])
        self.refuse("solve", "box.obj", "--rows", "rows.csv", words=["--rows", "box.obj"])
        self.refuse("compare", "plates.mtx", "f.h5", words=["has 2 rows", "f.h5"])
        self.refuse("compare", "plates.mtx", "plates.mtx", "--gather", words=["--gather"])
        self.refuse("compare", "plates.mtx", "box.obj", words=["box.obj", "MatrixMarket"])
        self.refuse("compare", "plates.mtx", "plates.mtx", "-o", "x.png", words=["x.png"])


if __name__ == "__main__":
    unittest.main()
