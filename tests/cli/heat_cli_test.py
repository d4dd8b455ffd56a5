"""`radiosity heat`: conditions from a table and by name, files written, inputs refused."""

import csv
import math
import unittest

import h5py
import numpy as np

from cli_runner import SMALL, CliTest
from exr_file import ExrFile

SIGMA = 5.67037441918443e-8

# Two unit squares one above the other, seen from between them.
PLATES = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
o lower
f 1 2 3 4
o upper
f 8 7 6 5
"""

TABLE = """# a comment
surface,emissivity,temperature_K,flux_W_per_m2,power_W,convection_W_per_m2_K,ambient_K,isothermal
*,0.8,,0,,,,
ceiling,0.9,700,,,,,
"""


class Heat(CliTest):
    def setUp(self):
        super().setUp()
        self.write("walls.csv", TABLE)
        self.write("plates.obj", PLATES)

    def heat(self, *arguments, code=0):
        return self.report("heat", *arguments, code=code)["heat"]

    def rows(self, name):
        with open(self.folder / name, newline="") as file:
            return list(csv.DictReader(file))

    # F = 0.199824895698387 between the plates (Howell C-11), one row each: two equations by hand.
    def test_plates_under_the_sky_match_two_equations_by_hand(self):
        f, sky = 0.199824895698387, SIGMA * 250 ** 4
        report = self.heat("plates.obj", "--faces-as-patches", "--tolerance", "1e-9",
                           "--precision", "double", "--condition", "*.emissivity=0.7",
                           "--condition", "lower.temperature=500", "--condition", "upper.flux=40",
                           "--sky-temperature", "250")
        lower, upper = report["surfaces"]
        # J1 = e sigma T^4 + (1 - e) (F J2 + (1 - F) S); J2 = F J1 + (1 - F) S + q.
        e, falls = 0.7, (1 - f) * sky
        a = np.array([[1, -(1 - e) * f], [-f, 1]])
        j = np.linalg.solve(a, [e * SIGMA * 500 ** 4 + (1 - e) * falls, falls + 40])
        # Six digits are printed.
        self.assertAlmostEqual(lower["radiosity_W_per_m2"] / j[0], 1, delta=1e-5)
        self.assertAlmostEqual(upper["radiosity_W_per_m2"] / j[1], 1, delta=1e-5)
        h = f * j[0] + falls
        t = ((j[1] - (1 - e) * h) / (e * SIGMA)) ** 0.25
        self.assertAlmostEqual(upper["temperature_K"] / t, 1, delta=1e-5)
        self.assertAlmostEqual(report["imbalance_W"], 0, delta=1e-6)
        self.assertEqual(report["linear_solver"], "solved directly")

    def test_pictures_show_heat_by_patch(self):
        self.heat("plates.obj", "--patches", "20", "--condition", "*.emissivity=0.7", "--condition",
                  "lower.temperature=500", "--condition", "upper.flux=40", "-o", "h.h5")
        # From below, the upper plate alone is seen, in the middle of the picture.
        view = ["--camera", "eye=.5,.5,.1;target=.5,.5,1;up=0,1,0;fov=40", "--width", "60", "--height", "60"]
        with h5py.File(self.folder / "h.h5") as file:
            upper = file["form_factors/surface"][()] == 1
            stored = {"temperature": file["heat/temperature"][()], "net-flux": file["heat/net_flux"][()],
                      "heat-irradiance": file["heat/irradiance"][()].sum(1)}
        for name, values in stored.items():
            shown = self.report("render", "h.h5", "--show", name, *view, "-o", "p.exr", "-o", "p.png")["picture"]
            self.assertAlmostEqual(shown["lowest"] / values.min(), 1, delta=1e-5)
            self.assertAlmostEqual(shown["highest"] / values.max(), 1, delta=1e-5)
            pixels = ExrFile(self.folder / "p.exr").channels[name]
            self.assertGreaterEqual(pixels[5:-5, 5:-5].min(), values[upper].min() * (1 - 1e-6))
            self.assertLessEqual(pixels[5:-5, 5:-5].max(), values[upper].max() * (1 + 1e-6))
        # Patches have a temperature each, which is not interpolated.
        self.report("render", "h.h5", "--show", "temperature", "--samples", "1", *view, "-o", "p.exr")
        seen = np.unique(ExrFile(self.folder / "p.exr").channels["temperature"][5:-5, 5:-5])
        self.assertTrue(set(seen) <= set(stored["temperature"][upper].astype(np.float32)))

    def test_a_scene_without_heat_has_none_to_show(self):
        self.run_program("mesh", "plates.obj", "--patches", "20", "-o", "m.h5")
        self.refuse("render", "m.h5", "--show", "temperature", "-o", "p.png",
                    words=["m.h5: has no heat to show", "radiosity heat"])

    def test_an_adiabatic_room_has_the_temperature_of_its_one_warm_wall(self):
        report = self.heat("box.obj", "--thermal", "walls.csv", "--patches", "60", "--closure",
                           "enforce", "--precision", "double")
        for surface in report["surfaces"]:
            self.assertAlmostEqual(surface["temperature_K"], 700, delta=0.01)  # closure to 1e-6

    def test_lost_power_is_reported(self):
        # Flipped, the lower plate shows its back to the upper one.
        self.write("plates.obj", PLATES.replace("f 1 2 3 4", "f 4 3 2 1"))
        plates = ["plates.obj", "--patches", "8", "--condition", "*.emissivity=1"]
        run = self.run_program("heat", *plates, "--condition", "*.temperature=400")
        self.assertIn("lost on surfaces seen from behind", run.err)
        # A room of one temperature has no net powers to speak of, and nothing is lost.
        run = self.run_program("heat", "box.obj", "--patches", "200", "--closure", "enforce",
                               "--thermal", "walls.csv")
        self.assertNotIn("accounted", run.err)

    def test_all_files_hold_the_same_values(self):
        run = self.run_program("heat", "box.obj", *SMALL, "--thermal", "walls.csv", "--condition",
                               "wall.convection=5", "--condition", "wall.ambient=290",
                               "-o", "x.h5", "-o", "x.csv", "-o", "x.vtp", "--patch-table", "p.csv")
        self.assertIn("unknown by hemicube", run.out)
        surfaces = {row["surface"]: row for row in self.rows("x.csv")}
        patches = self.rows("p.csv")
        with h5py.File(self.folder / "x.h5") as file:
            heat, area = file["heat"], file["mesh/area"][()]
            names = file["mesh/surface_names"][()]
            surface = file["form_factors/surface"][()]
            np.testing.assert_allclose([float(p["temperature_K"]) for p in patches],
                                       heat["temperature"][()], rtol=1e-15)
            self.assertEqual(heat["temperature"].attrs["unit"], b"K")
            for s, name in enumerate(names):
                mine = surface == s
                row = surfaces[name.decode()]
                self.assertAlmostEqual(
                    float(row["radiated_W"]) / np.sum((area * heat["net_flux"][()])[mine]), 1,
                    delta=1e-9)
                self.assertAlmostEqual(
                    float(row["temperature_K"]),
                    np.average(heat["temperature"][()][mine], weights=area[mine]), delta=1e-6)
            balance = heat["summary/balance_W"].attrs
            self.assertAlmostEqual(balance["radiated"],
                                   balance["to_sky"] + balance["on_backs"] + balance["imbalance"])
        self.assertIn("temperature", (self.folder / "x.vtp").read_text(errors="replace"))
        self.assertEqual(surfaces["ceiling/lamp"]["convected_W"], "0")

    def test_form_factors_and_heat_are_reused(self):
        self.run_program("factors", "box.obj", *SMALL, "-o", "x.h5")
        first = self.report("heat", "x.h5", "--thermal", "walls.csv")
        self.assertEqual(first["stages"]["form_factors"]["action"], "reused")
        again = self.report("heat", "x.h5", "--thermal", "walls.csv")
        self.assertEqual(again["stages"]["heat"]["action"], "reused")
        self.assertEqual(again["heat"], first["heat"])
        # A solution keeps the heat; other form factors drop it.
        other = self.report("solve", "x.h5")
        self.assertEqual(other["stages"]["heat"]["action"], "kept")
        run = self.run_program("heat", "x.h5", "--thermal", "walls.csv", "--condition",
                               "ceiling.temperature=710")
        self.assertIn("recomputed: conditions changed", run.out)
        self.assertIn("heat exchange", self.run_program("info", "x.h5").out)
        dropped = self.report("factors", "x.h5", "--resolution", "64")
        self.assertEqual(dropped["stages"]["heat"]["action"], "dropped")
        with h5py.File(self.folder / "x.h5") as file:
            self.assertNotIn("heat", file)

    def test_the_results_file_keeps_the_conditions(self):
        solved = ["--thermal", "walls.csv", "--condition", "ceiling.temperature=710"]
        self.run_program("heat", "box.obj", *SMALL, *solved, "-o", "done.h5", "-o", "first.csv")
        again = self.report("heat", "done.h5", "-o", "again.csv")
        self.assertEqual(again["stages"]["heat"]["action"], "reused")
        self.assertEqual((self.folder / "again.csv").read_bytes(),
                         (self.folder / "first.csv").read_bytes())
        # They hold by name for another mesh, too.
        other = self.report("heat", "done.h5", "--patches", "100", "--patch-table", "p.csv")
        self.assertEqual(other["stages"]["heat"]["action"], "recomputed")
        self.assertAlmostEqual(other["heat"]["surfaces"][1]["temperature_K"], 710)
        said = self.run_program("info", "done.h5").out
        for line in TABLE.splitlines() + ["ceiling.temperature=710"]:
            self.assertIn(line, said)
        # Another stage keeps them with the heat; conditions that are given replace them.
        self.run_program("solve", "done.h5")
        self.run_program("heat", "done.h5", "--thermal", "walls.csv")
        self.assertNotIn("710", self.run_program("info", "done.h5").out)
        # A missing name is reported by its line of the file's table.
        with h5py.File(self.folder / "done.h5", "r+") as file:
            table = file["heat/condition_table"][()]
            file["heat/condition_table"][...] = [table[0].replace(b"ceiling", b"cellar2")]
        self.refuse("heat", "done.h5", "-o", "x.csv",
                    words=["done.h5: /heat/condition_table:4", "cellar2", "there are: "])

    def test_a_results_file_without_conditions_asks_for_them(self):
        self.run_program("factors", "box.obj", *SMALL, "-o", "x.h5")
        self.refuse("heat", "x.h5", "-o", "x.csv", words=["no conditions are given"])

    def test_unused_options_of_light_are_named(self):
        small = ["heat", "box.obj", *SMALL, "--thermal", "walls.csv"]
        run = self.run_program(*small, "--set", "lamp.reflectance=.3", "--sky", "3", "--kd-is", "srgb")
        self.assertIn("about light, not used by heat: --set, --sky (heat has --sky-temperature), "
                      "--kd-is\n", run.err)
        self.assertNotIn("->", run.out + run.err)
        # Faces without a material have a default reflectance, which heat does not use.
        run = self.run_program("heat", "plates.obj", "--patches", "8", "--condition",
                               "*.emissivity=.5", "--condition", "*.temperature=300")
        self.assertEqual(run.err, "")
        self.assertIn("no material", self.run_program("solve", "plates.obj", "--patches", "8",
                                                      "--sky", "1").err)

    def test_losses_are_shares_of_the_power_given_off(self):
        # Net powers nearly vanish if all surfaces have one temperature.
        room = ["box.obj", "--patches", "60", "--method", "exact", "--condition", "*.emissivity=.9",
                "--condition", "*.flux=0", "--condition", "ceiling.temperature=300"]
        run = self.run_program("heat", *room)
        self.assertEqual(run.err, "")
        heat = self.heat(*room)
        # About sigma 300^4 from six walls of 1 m^2.
        self.assertAlmostEqual(heat["given_off_W"] / (6 * SIGMA * 300 ** 4), 1, delta=.01)
        self.write("plates.obj", PLATES.replace("f 1 2 3 4", "f 4 3 2 1"))
        run = self.run_program("heat", "plates.obj", "--patches", "8", "--condition",
                               "*.emissivity=1", "--condition", "*.temperature=400")
        # Two black plates at one temperature: half is the upper one's, and F of that meets the back.
        self.assertIn("9.99% of what all surfaces give off", run.err)

    def test_temperatures_beyond_all_bounds_are_refused(self):
        small = ["heat", "box.obj", *SMALL, "--condition", "*.emissivity=.9", "-o", "x.csv"]
        for condition, words in [("*.temperature=1e99", ["*.temperature=1e99", "above 1e+08 K"]),
                                 ("*.flux=1e300", ["flux 1e+300 W/m^2"]),
                                 ("room.power=-1e300", ["power -1e+300 W"])]:
            self.refuse(*small, "--condition", "*.temperature=300", "--condition", condition,
                        words=words)
        self.refuse(*small, "--condition", "*.temperature=300", "--sky-temperature", "1e80",
                    words=["--sky-temperature", "0 to 100,000,000"])

    def test_all_surfaces_without_emissivity_are_named(self):
        self.refuse("heat", "box.obj", *SMALL, "--condition", "*.temperature=300",
                    words=["no emissivity for room/wall, ceiling/lamp"])

    def test_patterns_name_surfaces(self):
        heat = self.heat("box.obj", *SMALL, "--condition", "*.emissivity=.8", "--condition",
                         "*oo*.temperature=300", "--condition", "c?iling*.temperature=400")
        self.assertEqual([s["temperature_K"] for s in heat["surfaces"]], [300, 400])
        self.refuse("heat", "box.obj", *SMALL, "--thermal", "walls.csv", "--condition",
                    "*cieling*.flux=0", words=["*cieling* matches no surface", "there are: ceiling"])

    def test_groups_are_named_by_conditions_and_tables(self):
        group = ["--group", "all=*"]
        heat = self.heat("box.obj", *SMALL, *group, "--condition", "all.emissivity=.8", "--condition",
                         "all.temperature=300", "-o", "box.h5")
        self.assertEqual([(s["name"], s["temperature_K"]) for s in heat["surfaces"]], [("all", 300)])
        self.assertIn("group all=*", self.run_program("info", "box.h5").out)
        again = self.report("heat", "box.h5")
        self.assertEqual(again["stages"]["heat"]["action"], "reused")
        self.assertEqual([s["name"] for s in again["heat"]["surfaces"]], ["all"])
        other = self.report("heat", "box.h5", "--group", "all=room*", "--group", "all=ceil*")
        self.assertEqual(other["stages"]["heat"]["action"], "recomputed")
        self.run_program("factors", "box.obj", *SMALL, "-o", "box.mtx")
        heat = self.heat("box.mtx", *group, "--condition", "all.emissivity=.8", "--condition",
                         "all.temperature=300")
        self.assertEqual([s["name"] for s in heat["surfaces"]], ["all"])

    def test_bands_of_one_emissivity_are_grey(self):
        common = ["box.obj", *SMALL, "--thermal", "walls.csv", "--condition", "wall.flux=100"]
        grey = self.heat(*common)
        for option in (("--band-edges", "2,5"), ("--band-fractions", "0.25,0.75")):
            banded = self.heat(*common, *option)
            self.assertGreater(banded["bands"], 1)
            for a, b in zip(grey["surfaces"], banded["surfaces"]):
                self.assertAlmostEqual(a["temperature_K"], b["temperature_K"], delta=2e-3)

    def test_a_results_file_keeps_its_bands(self):
        for option, bands in (("--band-edges", "1.5,3.25,7.125,11.0625,20.5,33.25"),
                              ("--band-fractions", ".0625,.09375,.125,.21875,.125,.1875,.1875")):
            first = self.heat("box.obj", *SMALL, "--thermal", "walls.csv", option, bands, "-o", "x.h5")
            self.assertEqual(first["bands"], 7)
            again = self.report("heat", "x.h5", "-o", "x.csv")
            self.assertEqual(again["stages"]["heat"]["action"], "reused")
            self.assertEqual(again["heat"]["bands"], 7)

    def test_threads_change_no_bit(self):
        for threads in ("1", "2"):
            self.run_program("heat", "box.obj", "--patches", "2000", "--method", "hemicube",
                             "--resolution", "32", "--thermal", "walls.csv", "--condition",
                             "wall.flux=20", "--threads", threads, "--patch-table",
                             f"{threads}.csv")
        self.assertEqual((self.folder / "1.csv").read_bytes(), (self.folder / "2.csv").read_bytes())

    def test_wrong_conditions_are_refused_in_one_line(self):
        def refuse(*arguments, words):
            self.refuse("heat", "box.obj", *SMALL, *arguments, words=words)

        def table(text, *words):
            self.write("bad.csv", text)
            refuse("--thermal", "bad.csv", words=words)

        refuse(words=["no conditions are given", "--thermal FILE.csv"])
        refuse("--thermal", "none.csv", words=["none.csv", "no such file"])
        refuse("--thermal", "walls.csv", "--condition", "door.flux=1",
               words=["door", "there are: ", "ceiling", "wall"])
        refuse("--thermal", "walls.csv", "--condition", "ceiling.flux=5",
               words=["have no level", "ceiling"])
        refuse("--thermal", "walls.csv", "--condition", "ceiling.emissivity=.5;.6",
               words=["ceiling", "2 emissivities for 1 bands"])
        refuse("--thermal", "walls.csv", "--condition", "wall.flux=-1e6",
               words=["wall", "more heat is taken out"])
        refuse("--thermal", "walls.csv", "--sky-temperature", "-4", words=["--sky-temperature"])
        refuse("--thermal", "walls.csv", "--band-edges", "3,2", words=["--band-edges", "increase"])
        refuse("--thermal", "walls.csv", "--band-edges", "3,x", words=["--band-edges", "`x`"])
        refuse("--thermal", "walls.csv", "--band-fractions", ".5,.6", words=["sum to 1.1"])
        refuse("--thermal", "walls.csv", "--patch-table", "x.txt", words=["--patch-table writes .csv"])
        refuse("--thermal", "walls.csv", "-o", "x.png", words=["heat writes", ".csv"])
        table("surface,emissivity\n", "bad.csv: holds no conditions")
        table("", "bad.csv", "empty")
        table("surface;emissivity;temperature_K\nwall;0,5;300\n", "bad.csv:1", "write commas",
              "points in numbers")
        table("surface,epsilon\nwall,1\n", "bad.csv:1", "column `epsilon` is unknown", "emissivity")
        table("emissivity,flux_W_per_m2\n.5,0\n", "bad.csv:1", "names no column `surface`")
        table("surface,emissivity,temperature_K\n*,.5,300\nwall,.5\n", "bad.csv:3", "2 fields")
        table("surface,emissivity,temperature_K\nwall,high,300\n", "bad.csv:2: wall", "`high`")
        table("surface,emissivity,temperature_K,flux_W_per_m2\n*,.5,300,4\n", "bad.csv:2",
              "more than one of temperature, flux and power")
        table("surface,emissivity,temperature_K\nroom,.5,300\nwall,.5,300\nceiling,1,3\n",
              "bad.csv:3", "named here and in bad.csv:2")
        table("surface,emissivity,temperature_K\nwall,.5,300\n", "no condition for ceiling/lamp")
        table("surface,emissivity,temperature_K\n*,.5,300\nwall,300:.1 400:.2,500\n",
              "wall", "reaches 500 K", "300 to 400 K")

    def test_a_damaged_stage_is_named(self):
        self.run_program("heat", "box.obj", *SMALL, "--thermal", "walls.csv", "-o", "x.h5")
        with h5py.File(self.folder / "x.h5", "r+") as file:
            values = file["heat/temperature"][()]
            del file["heat/temperature"]
            file["heat/temperature"] = values[1:]
        self.refuse("info", "x.h5", words=["/heat/temperature", f"not {len(values)}"])

    def test_a_heat_solution_that_did_not_converge_fails(self):
        run = self.run_program("heat", "box.obj", *SMALL, "--thermal", "walls.csv", "--condition",
                               "wall.convection=5", "--condition", "wall.ambient=290",
                               "--heat-iterations", "1", code=1)
        self.assertIn("not converged after 1 iterations", run.err)

    def test_names_with_commas_and_quotes_are_read_and_written(self):
        self.write("plates.obj", PLATES.replace("o lower", 'o the "low", plate'))
        self.write("q.csv", 'surface,emissivity,temperature_K\n"the ""low"", plate",.5,300\n*,.5,400\n')
        self.run_program("heat", "plates.obj", "--patches", "8", "--thermal", "q.csv", "-o", "s.csv")
        self.assertTrue(self.rows("s.csv")[0]["surface"].startswith('the "low", plate'))
        self.assertTrue(math.isclose(float(self.rows("s.csv")[0]["temperature_K"]), 300))

    def test_radiant_temperatures_of_an_isothermal_box(self):
        box = ["box.obj", "--method", "exact", "--patches", "60", "--condition", "*.temperature=310", "--condition",
               "*.emissivity=.7"]
        report = self.report("heat", *box, "--plane", ".2,.5,.2:.2,.5,.8:.8,.5,.8:.2", "--plane",
                             ".5,.1,.5:.5,.1,.6:.6,.1,.6:.1", "--point-table", "radiant.csv", "-o", "h.h5")
        rows = self.rows("radiant.csv")
        self.assertEqual(len(rows), 9 + 1)
        self.assertEqual(list(rows[0])[:5], ["x_m", "y_m", "z_m", "standing_K", "seated_K"])
        for row in rows:
            for name, value in row.items():
                if name.endswith("_K"):
                    # J of the walls is off by the form factors' rows that do not sum to 1: 1e-3 of 30%, a quarter.
                    self.assertAlmostEqual(float(value), 310, delta=.05)
            self.assertAlmostEqual(float(row["surfaces_seen"]), 1, delta=1e-9)
        for key in ("radiant", "radiant_2"):
            self.assertAlmostEqual(report[key]["standing_mean_K"], 310, delta=.05)
            self.assertAlmostEqual(report[key]["seated_highest_K"], 310, delta=.05)
        again = self.report("heat", "h.h5", "--plane", ".5,.1,.5:.5,.1,.6:.6,.1,.6:.1")["radiant"]
        self.assertEqual(again, report["radiant_2"])

    def test_points_of_heat_are_refused_early(self):
        box = ["box.obj", "--condition", "*.temperature=310", "--condition", "*.emissivity=.7"]
        for wrong, said in ((["--point-table", "r.csv"], "--point-table: say where"),
                            (["--point-table", "r.txt", "--grid", "room"], "r.txt: --point-table writes .csv"),
                            (["--plane", "1,2"], "--plane"),
                            (["--plane", "5,5,5:5,5,6:6,5,6"], "lie beyond the room")):
            self.assertIn(said, self.run_program("heat", *box, *wrong, code=2).err)


if __name__ == "__main__":
    unittest.main()
