"""The command line end to end: subcommands, files, stage reuse."""

import re
import shutil
import sys
import unittest

import h5py
import numpy as np
import scipy.io
import scipy.sparse

from cli_runner import DATA, SMALL, CliTest

COMMANDS = ["info", "mesh", "factors", "solve", "gather", "heat", "compare", "render"]


def actions(report):
    return {stage: entry["action"] for stage, entry in report["stages"].items()}


class Help(CliTest):
    def test_version_and_help_are_printed(self):
        self.assertRegex(self.run_program("--version").out, r"^radiosity \d+\.\d+\.\d+\n$")
        text = self.run_program("--help").out
        for command in COMMANDS:
            self.assertIn(command, text)

    def test_each_subcommand_has_units_defaults_and_an_example(self):
        for command in COMMANDS:
            text = self.run_program(command, "--help").out
            self.assertIn(f"  radiosity {command} ", text)
            self.assertIn("default", text)
            self.assertIn("W/m^2", text)
            self.assertLessEqual(max(map(len, text.splitlines())), 100)


class Subcommands(CliTest):
    def test_info_describes_the_scene(self):
        out = self.run_program("info", DATA / "cornell-box.obj").out
        for word in ["emitted power", "watertight", "upper corner", "open edges"]:
            self.assertIn(word, out)
        report = self.report("info", "box.obj")["scene"]
        self.assertEqual(report["faces"], 6)
        self.assertTrue(report["watertight"])
        # The ceiling is 1 m^2 and radiates pi times its Ke. Ke is read as written: rounding only.
        np.testing.assert_allclose(report["emitted_power_W"], np.pi * np.array([5, 4, 3]),
                                   rtol=1e-12)

    def test_mesh_writes_patches(self):
        report = self.report("mesh", "box.obj", "--patches", "100", "-o", "m.obj", "-o", "m.glb",
                             "-o", "m.h5")["mesh"]
        self.assertEqual(report["t_junctions"], 0)
        # A unit cube: 6 m^2 for any patches; sums of about 100 terms round to 1e-14.
        self.assertAlmostEqual(report["area_m2"], 6, delta=1e-12)
        faces = [l for l in (self.folder / "m.obj").read_text().splitlines() if l.startswith("f ")]
        self.assertEqual(len(faces), report["patches"])
        self.assertEqual((self.folder / "m.glb").read_bytes()[:4], b"glTF")
        with h5py.File(self.folder / "m.h5") as file:
            self.assertEqual(len(file["mesh/area"]), report["patches"])
            self.assertNotIn("form_factors", file)

    def test_factors_are_the_same_in_every_format(self):
        report = self.report("factors", "box.obj", *SMALL, "-o", "f.h5", "-o", "f.mtx")
        with h5py.File(self.folder / "f.h5") as file:
            g = file["form_factors"]
            matrix = scipy.sparse.csr_matrix((g["data"], g["indices"], g["indptr"]),
                                             g["shape"][()])
        text = scipy.io.mmread(self.folder / "f.mtx").tocsr()
        self.assertEqual(matrix.shape[0], report["mesh"]["patches"])
        self.assertEqual(abs(matrix - text).max(), 0)
        # In a closed scene a row sums to 1; entries are stored in single precision.
        np.testing.assert_allclose(np.asarray(matrix.sum(axis=1)).ravel(), 1, atol=2e-6)

    def test_a_closed_furnace_is_uniform(self):
        """Closed, rho = 0.5 and E = 1 everywhere: B = E / (1 - rho) = 2."""
        report = self.report("solve", DATA / "furnace-cube.obj", *SMALL, "--precision", "double",
                             "--solve-tolerance", "1e-12", "-o", "s.h5")["solution"]
        self.assertEqual(report["status"], "converged")
        self.assertTrue(report["usable"])
        with h5py.File(self.folder / "s.h5") as file:
            radiosity = file["solution/radiosity"][()]
        # Ke in the file is 1/pi to 9 digits, so E = 1 to 1e-8 and B = 2 to 2e-8.
        np.testing.assert_allclose(radiosity, 2, rtol=1e-8)

    def test_energy_is_accounted_for(self):
        energy = self.report("solve", "box.obj", *SMALL)["solution"]
        emitted, absorbed = np.array(energy["emitted_W"]), np.array(energy["absorbed_W"])
        np.testing.assert_allclose(emitted, np.pi * np.array([5, 4, 3]), rtol=1e-12)
        rest = emitted - absorbed - energy["to_sky_W"] - energy["on_backs_W"]
        np.testing.assert_allclose(rest, energy["imbalance_W"], atol=1e-9)

    def test_render_writes_every_format_at_once(self):
        names = ["p.png", "p.exr", "p.glb", "p.h5", "p.mtx"]
        outputs = [word for name in names for word in ("-o", name)]
        report = self.report("render", "box.obj", *SMALL, "--width", "40", "--samples", "1",
                             *outputs)
        # The stages come first: they are kept before anything is drawn.
        self.assertEqual([o["path"] for o in report["outputs"]],
                         ["p.h5", "p.png", "p.exr", "p.glb", "p.mtx"])
        for output in report["outputs"]:
            self.assertEqual((self.folder / output["path"]).stat().st_size, output["bytes"])
        self.assertEqual((self.folder / "p.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((self.folder / "p.exr").read_bytes()[:4], b"\x76\x2f\x31\x01")
        self.assertEqual((self.folder / "p.glb").read_bytes()[:4], b"glTF")
        self.assertIsInstance(report["picture"]["exposure_ev"], float)

    def test_elements_are_drawn_unless_patches_are_asked_for(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "e.h5")
        drawn = ["render", "e.h5", "--width", "40", "--samples", "1"]
        by_elements = self.report(*drawn, "-o", "on.png")["elements"]
        self.assertGreater(by_elements["direct_vertices"], 0)
        self.assertLess(by_elements["direct_vertices"], by_elements["uniform_vertices"])
        self.assertIn("largest_error", by_elements)
        finer = self.report(*drawn, "--element-tolerance", ".001", "-o", "fine.png")["elements"]
        self.assertGreater(finer["direct_vertices"], by_elements["direct_vertices"])
        self.assertNotIn("elements", self.report(*drawn, "--elements", "off", "-o", "off.png"))
        self.assertNotEqual((self.folder / "on.png").read_bytes(),
                            (self.folder / "off.png").read_bytes())

    def test_form_factors_that_only_elements_use_are_coarse(self):
        drawn = ["render", "box.obj", "--patches", "60", "--method", "exact", "--width", "40",
                 "--samples", "1", "-o", "p.png"]
        said = "form factors   exact between"
        for words, tolerance in [([], "0.03"), (["-o", "p.h5"], "0.001"),
                                 (["--elements", "off"], "0.001"), (["--tolerance", ".01"], "0.01")]:
            plan = next(line for line in self.run_program(*drawn, *words).out.splitlines()
                        if line.startswith(said))
            self.assertIn(f" to {tolerance}:", plan)

    def test_lit_meshes_show_elements_unless_patches_are_asked_for(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "e.h5")
        fine = self.report("solve", "e.h5", "-o", "on.glb")
        coarse = self.report("solve", "e.h5", "--elements", "off", "-o", "off.glb")
        self.assertNotIn("elements", coarse)
        self.assertGreater(fine["lit_mesh"]["triangles"], 2 * coarse["lit_mesh"]["triangles"])
        # Both are the same light: a hemicube of 32 pixels is good to some percent.
        gap = self.report("compare", "on.glb", "off.glb")["comparison"]
        self.assertLess(gap["relative_l2"], 0.1)
        self.assertEqual((gap["matched_a"], gap["matched_b"]), ("100.00%", "100.00%"))
        drawn = self.report("render", "e.h5", "--width", "40", "-o", "r.glb")
        self.assertEqual(drawn["lit_mesh"], fine["lit_mesh"])

    def test_a_lit_mesh_may_have_elements_only_where_the_camera_sees_it(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "e.h5")
        seen = ["render", "e.h5", "--width", "40", "--samples", "1", "--camera",
                "eye=.5,.5,.9;target=.5,.5,0;up=0,1,0;fov=20"]
        whole = self.report(*seen, "-o", "all.glb")
        part = self.report(*seen, "--visible-only", "-o", "seen.glb", "-o", "seen.png")
        self.assertLess(part["elements"]["indirect_vertices"],
                        whole["elements"]["indirect_vertices"])
        self.assertLess(part["lit_mesh"]["triangles"], whole["lit_mesh"]["triangles"])
        self.run_program(*seen, "-o", "picture.png")
        self.assertEqual((self.folder / "seen.png").read_bytes(),
                         (self.folder / "picture.png").read_bytes())

    def test_a_results_file_keeps_elements_on_request(self):
        self.assertNotIn("elements", self.report("solve", "box.obj", *SMALL, "-o", "e.h5"))
        self.report("solve", "e.h5", "--elements", "on")
        with h5py.File(self.folder / "e.h5") as file:
            field = file["elements/direct"]
            values, points = field["values"][()], field["points"][()]
            self.assertEqual(len(values), field.attrs["vertices"])
            self.assertLess(points.max(), len(values))
        for command, output in [("solve", "kept.glb"), ("render", "kept.png")]:
            run = self.run_program(command, "e.h5", "-o", output).out
            self.assertRegex(run, r"(?m)^elements +reused from e.h5$")
        stale = self.run_program("render", "e.h5", "--set", "wall.reflectance=.2", "-o", "x.png")
        self.assertRegex(stale.out, r"(?m)^elements +recomputed: solution changed$")
        dropped = self.report("solve", "e.h5", "--set", "wall.reflectance=.2")
        self.assertEqual(actions(dropped)["elements"], "dropped")
        with h5py.File(self.folder / "e.h5") as file:
            self.assertNotIn("elements", file)

    def test_light_is_gathered_at_every_pixel_on_demand(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "g.h5")
        drawn = ["render", "g.h5", "--width", "24", "--samples", "1", "-o", "g.png",
                 "--final-gather"]
        report = self.report(*drawn)
        self.assertNotIn("elements", report)
        gathered = report["final_gather"]
        self.assertGreater(gathered["points"], 0)
        self.assertLessEqual(gathered["rays"], 24 * 24 * gathered["rays_a_pixel"])
        for other in (["--elements", "off"], ["--flat"], ["--show", "radiosity"]):
            said = self.run_program(*drawn, *other, code=2).err
            self.assertIn("--final-gather: " + " ".join(other)[:6], said)

    def test_false_colour_shows_every_quantity(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")
        for quantity in ["radiosity", "irradiance", "row-sum", "form-factor:3"]:
            report = self.report("render", "s.h5", "--show", quantity, "--width", "64", "--samples",
                                 "1", "-o", "q.png", "-o", "q.exr")
            self.assertIn("highest", report["picture"])
        # A picture of form factors needs no light.
        self.run_program("render", "box.obj", *SMALL, "--set", "lamp.radiance=0", "--show",
                         "row-sum", "--width", "64", "-o", "q.png")

    def test_report_has_the_figures_that_are_printed(self):
        report = self.report("solve", "box.obj", *SMALL)
        out = self.run_program("solve", "box.obj", *SMALL).out
        printed = re.search(r"iterations +([\d,]+)", out).group(1)
        self.assertEqual(report["solution"]["iterations"], int(printed.replace(",", "")))
        self.assertEqual(report["command"], "solve")
        self.assertEqual(report["exit_code"], 0)
        for section, keys in {
                "mesh": ["patches", "t_junctions", "smallest_angle_deg", "surfaces"],
                "form_factors": ["hemicubes", "skipped_horizon", "skipped_own_plane",
                                 "skipped_facing_away", "skipped_hidden", "matrix_bytes", "reciprocity_residual"],
                "solution": ["status", "iterations", "residual", "error_bound_W_per_m2",
                             "emitted_W", "absorbed_W", "to_sky_W", "on_backs_W", "usable"]}.items():
            for key in keys:
                self.assertIn(key, report[section])

    def test_notes_that_differ_in_names_alone_are_printed_three_times(self):
        names = ["oak/bark", "elm_top/leaf2", "the ash/bark", "yew/leaf", "fir/bark"]
        lines = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 2 0 0"]
        for name in names:
            lines += [f"o {name.split('/')[0]}", f"usemtl {name.split('/')[1]}", "f 1 2 3", "f 1 2 4"]
        (self.folder / "trees.obj").write_text("\n".join(lines) + "\n")
        err = self.run_program("info", "trees.obj").err
        self.assertEqual(err.count("1 of 2 faces have no area"), 3)
        self.assertRegex(err, r"1 of 2 faces have no area [^\n]* \(and 2 more like this\)")

    def test_a_pipe_gets_plain_text(self):
        run = self.run_program("render", "box.obj", *SMALL, "-o", "p.png")
        self.assertNotRegex(run.out + run.err, r"[\x00-\x09\x0b-\x1f\x7f]")
        self.assertEqual(self.run_program("render", "box.obj", *SMALL, "-o", "p.png",
                                          "--quiet").out, "")

    def test_threads_do_not_change_a_bit(self):
        data = []
        for threads in ["1", "2"]:
            self.run_program("solve", "box.obj", *SMALL, "--threads", threads, "-o", f"t{threads}.h5")
            with h5py.File(self.folder / f"t{threads}.h5") as file:
                data.append((file["form_factors/data"][()].tobytes(),
                             file["solution/radiosity"][()].tobytes()))
        self.assertEqual(data[0], data[1])


class Reuse(CliTest):
    def setUp(self):
        super().setUp()
        self.run_program("solve", "box.obj", *SMALL, "-o", "s.h5")

    def test_an_unchanged_run_recomputes_nothing(self):
        before = (self.folder / "s.h5").read_bytes()
        report = self.report("solve", "s.h5")
        self.assertEqual(set(actions(report).values()), {"reused"})
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)

    def test_options_equal_to_those_of_the_file_recompute_nothing(self):
        report = self.report("solve", "s.h5", *SMALL, "--seed", "1")
        self.assertEqual(set(actions(report).values()), {"reused"})

    def test_changed_materials_recompute_the_solution_alone(self):
        report = self.report("solve", "s.h5", "--set", "wall.reflectance=0.1")
        self.assertEqual(actions(report), {"mesh": "reused", "form_factors": "reused",
                                           "solution": "recomputed"})
        self.assertIn("materials changed", report["stages"]["solution"]["detail"])
        # The change stays in the file.
        again = self.report("solve", "s.h5")
        self.assertEqual(set(actions(again).values()), {"reused"})
        self.assertEqual(again["solution"]["absorbed_W"], report["solution"]["absorbed_W"])

    def test_a_changed_solver_keeps_the_form_factors(self):
        report = self.report("solve", "s.h5", "--solver", "jacobi")
        self.assertEqual(actions(report)["form_factors"], "reused")
        self.assertEqual(report["stages"]["solution"]["detail"], "solver auto -> jacobi")

    def test_a_changed_resolution_recomputes_the_form_factors(self):
        report = self.report("solve", "s.h5", "--resolution", "64")
        self.assertEqual(actions(report), {"mesh": "reused", "form_factors": "recomputed",
                                           "solution": "recomputed"})
        self.assertEqual(report["stages"]["form_factors"]["detail"], "resolution 32 -> 64")
        out = self.run_program("solve", "s.h5", "--resolution", "32").out
        self.assertRegex(out, r"(?m)^form factors +recomputed: resolution 64 -> 32$")
        self.assertRegex(out, r"(?m)^mesh +reused from s.h5$")

    def test_options_of_the_other_method_change_nothing(self):
        self.run_program("solve", "box.obj", "--patches", "60", "--method", "auto", "-o", "a.h5")
        for given in [["--resolution", "64"], ["--seed", "2"], ["--method", "exact"]]:
            report = self.report("solve", "a.h5", *given)
            self.assertEqual(set(actions(report).values()), {"reused"}, given)
        report = self.report("solve", "a.h5", "--tolerance", "0.01")
        self.assertEqual(actions(report)["form_factors"], "recomputed")
        self.assertEqual(actions(report)["solution"], "recomputed")
        # auto does not pick the requested hemicubes here.
        report = self.report("factors", "s.h5", "--method", "auto")
        self.assertEqual(actions(report)["form_factors"], "recomputed")
        self.assertEqual(report["form_factors"]["method"], "exact")

    def test_a_changed_patch_count_recomputes_everything(self):
        report = self.report("solve", "s.h5", "--patches", "200")
        self.assertEqual(set(actions(report).values()), {"recomputed"})
        self.assertEqual(report["stages"]["mesh"]["detail"], "patches 60 -> 200")
        self.assertIn("mesh changed", report["stages"]["form_factors"]["detail"])

    def test_factors_drop_a_solution_that_no_longer_fits(self):
        report = self.report("factors", "s.h5", "--resolution", "64")
        self.assertEqual(actions(report)["solution"], "dropped")
        with h5py.File(self.folder / "s.h5") as file:
            self.assertNotIn("radiosity", file.get("solution", {}))
        self.assertEqual(actions(self.report("solve", "s.h5"))["form_factors"], "reused")

    def test_factors_keep_a_solution_that_fits(self):
        self.run_program("factors", "s.h5", "-o", "copy.h5")
        self.assertEqual(set(actions(self.report("solve", "copy.h5")).values()), {"reused"})

    def test_the_scene_file_may_be_gone(self):
        (self.folder / "box.obj").unlink()
        (self.folder / "box.mtl").unlink()
        self.run_program("render", "s.h5", "--width", "32", "-o", "p.png")
        self.run_program("info", "s.h5")
        self.run_program("solve", "s.h5", "--patches", "100")

    def test_a_scene_file_reuses_an_existing_results_file(self):
        report = self.report("solve", "box.obj", *SMALL, "-o", "s.h5")
        self.assertEqual(set(actions(report).values()), {"reused"})
        self.write("box.mtl", "newmtl lamp\nKe 9 9 9\nKd 0 0 0\nnewmtl wall\nKd 0.3 0.3 0.3\n")
        report = self.report("solve", "box.obj", *SMALL, "-o", "s.h5")
        self.assertEqual(actions(report), {"mesh": "reused", "form_factors": "reused",
                                           "solution": "recomputed"})
        # A command's meaning does not depend on its output file: these are the defaults.
        report = self.report("mesh", "box.obj", "-o", "s.h5")
        self.assertEqual(actions(report)["mesh"], "recomputed")

    def test_stages_run_one_by_one_give_the_bits_of_one_run(self):
        self.run_program("mesh", "box.obj", *SMALL[:2], "-o", "steps.h5")
        self.run_program("factors", "steps.h5", *SMALL[2:])
        self.run_program("solve", "steps.h5")
        with h5py.File(self.folder / "s.h5") as a, h5py.File(self.folder / "steps.h5") as b:
            for name in ["form_factors/data", "solution/radiosity"]:
                self.assertEqual(a[name][()].tobytes(), b[name][()].tobytes())

    def test_render_leaves_its_input_alone(self):
        before = (self.folder / "s.h5").read_bytes()
        out = self.run_program("render", "s.h5", "--set", "wall.reflectance=0.9", "--width", "32",
                               "-o", "p.png").out
        self.assertIn("left as it is", out)
        self.assertEqual((self.folder / "s.h5").read_bytes(), before)


class ExactFactors(CliTest):
    def test_the_default_method_is_exact_with_its_reason(self):
        report = self.report("factors", "box.obj", "--patches", "60", "-o", "f.h5")
        factors = report["form_factors"]
        self.assertEqual(factors["method"], "exact")
        self.assertRegex(factors["method_reason"], "^it takes .* s(; rays, to .*, would take .* s)?$")
        for key in ["pairs_unoccluded", "pairs_occluded", "pairs_hidden", "pairs_no_exchange",
                    "error_figure", "row_error_median", "largest_row_error", "closed"]:
            self.assertIn(key, factors)
        out = self.run_program("factors", "box.obj", "--patches", "60").out
        self.assertRegex(out, r"(?m)^  pairs unoccluded +[\d,]+$")
        self.assertRegex(out, r"(?m)^  error of F, relL2 +[\d.e-]+$")
        with h5py.File(self.folder / "f.h5") as file:
            group = file["form_factors"]
            n = group["shape"][0]
            self.assertEqual(group.attrs["method"], b"exact")
            self.assertEqual(group["error"].shape, (n,))
            matrix = scipy.sparse.csr_matrix((group["data"], group["indices"], group["indptr"]),
                                   group["shape"][()]).toarray().astype(float)
            exchange = group["area"][()][:, None] * matrix
            # One value a pair is stored, in single precision.
            np.testing.assert_allclose(exchange, exchange.T, rtol=2e-7)
            np.testing.assert_allclose(matrix.sum(axis=1), 1, atol=3e-5)

    def test_options_of_other_methods_are_named(self):
        for method, given, named in [
                ("exact", ["--resolution", "64", "--eye", "cpu", "--seed", "3"], "exact: --seed, --resolution, --eye"),
                ("rays", ["--seed", "3", "--symmetrize"], "rays: --symmetrize"),
                ("hemicube", ["--seed", "3", "--resolution", "32", "--tolerance", "0.01"], "hemicube: --tolerance")]:
            run = self.run_program("factors", "box.obj", "--patches", "30", "--method", method, *given, "-o",
                                   f"{method}.h5")
            self.assertIn(f"not used by the method {named}\n", run.err)
        run = self.run_program("factors", "exact.h5", "--seed", "3")
        self.assertIn("form factors   reused", run.out)
        self.assertIn("not used by the method exact: --seed\n", run.err)

    def test_options_are_part_of_the_key(self):
        self.run_program("factors", "box.obj", "--patches", "60", "-o", "f.h5")
        self.assertEqual(actions(self.report("factors", "f.h5"))["form_factors"], "reused")
        report = self.report("factors", "f.h5", "--tolerance", "1e-5")
        self.assertEqual(report["stages"]["form_factors"]["action"], "recomputed")
        self.assertEqual(report["stages"]["form_factors"]["detail"], "tolerance default -> 1e-05")
        report = self.report("factors", "f.h5", "--method", "hemicube")
        self.assertIn("method auto -> hemicube", report["stages"]["form_factors"]["detail"])
        report = self.report("factors", "f.h5", "--near", "exact")
        self.assertIn("near off -> exact", report["stages"]["form_factors"]["detail"])
        self.assertGreater(report["form_factors"]["near_pairs"], 0)

    def test_closed_forms_give_ten_digits_with_one_patch_a_face(self):
        report = self.report("factors", DATA / "facing-plates.obj", "--faces-as-patches",
                             "--tolerance", "1e-11", "-o", "f.h5")
        self.assertLess(report["form_factors"]["error_figure"], 1e-10)
        with h5py.File(self.folder / "f.h5") as file:
            data = file["form_factors/data"][()]
        self.assertEqual(data.dtype, np.float64)
        # Howell C-11: unit squares at distance 1, recomputed with 20 digits.
        np.testing.assert_allclose(data, 0.199824895698387, rtol=1e-10)


class Physics(CliTest):
    def test_a_finer_mesh_keeps_the_brightness(self):
        def means(patches):
            self.run_program("solve", DATA / "cornell-box.obj", "--patches", patches, "--method",
                             "hemicube", "--resolution", "128", "-o", "c.h5")
            with h5py.File(self.folder / "c.h5") as file:
                area, surface = file["mesh/area"][()], file["mesh/surface"][()]
                radiosity = file["solution/radiosity"][()]
            return np.array([
                np.average(radiosity[surface == s], axis=0, weights=area[surface == s])
                for s in np.unique(surface)])

        coarse, fine = means("400"), means("1600")
        self.assertEqual(coarse.shape, fine.shape)
        # One eye a patch is off by the patch's size over the distance, squared, near edges: per
        # cents at 400 patches. A surface that doubles with its patch count is off by 100%.
        np.testing.assert_allclose(fine, coarse, rtol=0.05)


if __name__ == "__main__":
    sys.exit(unittest.main())
