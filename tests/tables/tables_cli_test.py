"""Tables of form factors by `factors`, read back and compared with the results file."""
import csv
import json
import re
import sys
import unittest
from pathlib import Path

import h5py
import numpy
import scipy.io
import scipy.sparse

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "cli"))
from cli_runner import DATA, CliTest  # noqa: E402

ROOM = ["factors", DATA / "cornell-box.obj", "--patches", 120, "--method", "exact"]


def read_csv(path):
    with path.open(newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]


def read_view3d(path):
    """As View3D's own reader does: a line of at most 34 characters, then numbers between blanks."""
    header, rest = path.read_text().split("\n", 1)
    assert len(header) <= 34
    program, version, layout, enclosure, emittances, count = header.split()
    n = int(count)
    numbers = numpy.array(rest.split(), dtype=float)
    assert (layout, emittances, numbers.size) == ("0", "0", n + n * n + n)
    return int(enclosure), numbers[:n], numbers[n:n + n * n].reshape(n, n), numbers[n + n * n:]


class Truth:
    """Form factors between groups, summed by numpy from the patches' own in the results file."""

    def __init__(self, path, groups=()):
        with h5py.File(path) as file:
            f = file["form_factors"]
            self.patches = scipy.sparse.csr_matrix(
                (f["data"][()].astype(float), f["indices"][()], f["indptr"][()]), f["shape"][()])
            area = f["area"][()]
            surface = f["surface"][()]
            names = [name.decode() for name in f["surface_names"][()]]
            sky, backs = f["sky"][()], f["backs"][()]
            self.sky_of_patches, self.backs_of_patches = sky, backs
        group_of = {name: next((g for g, members in groups if name in members), name)
                    for name in names}
        self.names = list(dict.fromkeys([g for g, _ in groups] +
                                        [group_of[n] for n in names]))
        index = numpy.array([self.names.index(group_of[names[s]]) for s in surface])
        join = numpy.zeros((len(self.names), len(area)))
        join[index, numpy.arange(len(area))] = area
        self.area = join.sum(axis=1)
        self.factors = join @ self.patches @ (join > 0).T / self.area[:, None]
        self.sky = join @ sky / self.area
        self.backs = join @ backs / self.area


WALLS = ("walls", ["back_wall/white", "right_wall/green", "left_wall/red"])


class Tables(CliTest):
    # F of the far side of a pair is rounded to 32 bits in the results file, not in the sums.
    def assert_close(self, a, b):
        numpy.testing.assert_allclose(a, b, rtol=2e-7, atol=1e-12)

    def test_wide_csv_json_and_markdown_hold_the_same_values(self):
        self.run_program(*ROOM, "--group", "walls=*wall/*", "-o", "t.csv", "-o", "t.json",
                         "-o", "t.md", "-o", "t.h5")
        truth = Truth(self.folder / "t.h5", [WALLS])
        header, rows = read_csv(self.folder / "t.csv")
        n = len(truth.names)
        self.assertEqual(header, ["name", "area_m2", *truth.names, "sky", "backs", "sum", "error",
                                  "reciprocity_m2"])
        self.assertEqual([row[0] for row in rows], truth.names)
        values = numpy.array([row[1:] for row in rows], dtype=float)
        self.assert_close(values[:, 0], truth.area)
        self.assert_close(values[:, 1:n + 1], truth.factors)
        self.assert_close(values[:, n + 1], truth.sky)
        self.assert_close(values[:, n + 2], truth.backs)
        # Accounts sum to 1; values are stored in single precision.
        self.assert_close(values[:, n + 3], 1)
        self.assertTrue((values[:, n + 4] > 0).all())
        table = json.loads((self.folder / "t.json").read_text())
        self.assertEqual(table["names"], truth.names)
        numpy.testing.assert_array_equal(table["form_factors"], values[:, 1:n + 1])
        numpy.testing.assert_array_equal(table["sky"], values[:, n + 1])
        numpy.testing.assert_array_equal(table["error"], values[:, n + 4])
        self.assertEqual(numpy.shape(table["entry_error"]), (n, n))
        lines = (self.folder / "t.md").read_text().splitlines()
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
        self.assertEqual(cells[0], ["from", "area m^2", *truth.names, "sky", "backs", "error"])
        self.assertTrue(all(re.fullmatch("-+:?", cell) for cell in cells[1]))
        printed = numpy.array([row[2:n + 2] for row in cells[2:]], dtype=float)
        numpy.testing.assert_allclose(printed, truth.factors, rtol=6e-6, atol=1e-12)

    def test_areas_have_the_digits_that_are_meant(self):
        # Sums of patches' areas: 4 m x 3 m are 12 m^2 and not 11.999999999999972.
        (self.folder / "floor.obj").write_text("v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\n"
                                               "o floor\nf 1 2 3 4\n")
        for patches in (100, 250, 330):
            self.run_program("factors", "floor.obj", "--patches", patches, "--between", "surfaces",
                             "-o", "t.csv")
            self.assertEqual(read_csv(self.folder / "t.csv")[1][0][1], "12")

    def test_long_tables_have_a_row_a_pair(self):
        self.run_program(*ROOM, "--layout", "long", "-o", "t.csv", "-o", "t.json", "-o", "t.h5",
                         "--sky-name", "open front")
        truth = Truth(self.folder / "t.h5")
        header, rows = read_csv(self.folder / "t.csv")
        self.assertEqual(header, ["from", "to", "area_m2", "form_factor", "error", "reciprocity_m2"])
        found = {(row[0], row[1]): row[2:] for row in rows}
        self.assertEqual(len(found), len(truth.names) * (len(truth.names) + 2))
        for a, name in enumerate(truth.names):
            for b, other in enumerate(truth.names):
                self.assert_close(float(found[name, other][0]), truth.area[a])
                self.assert_close(float(found[name, other][1]), truth.factors[a, b])
                self.assertGreaterEqual(float(found[name, other][2]), 0)
            self.assert_close(float(found[name, "open front"][1]), truth.sky[a])
            self.assert_close([float(cell) for cell in found[name, "backs"][:2]],
                              [truth.area[a], truth.backs[a]])
        pairs = json.loads((self.folder / "t.json").read_text())["pairs"]
        self.assertEqual({(p["from"], p["to"]): p["form_factor"] for p in pairs},
                         {pair: float(cells[1]) for pair, cells in found.items()})

    def test_groups_reuse_form_factors_and_are_printed(self):
        self.run_program(*ROOM, "-o", "t.h5")
        before = (self.folder / "t.h5").read_bytes()
        run = self.run_program("factors", "t.h5", "--between", "groups", "--group", "walls=*wall/*",
                               "--group", "left=left*", "--group", "left=short*",
                               "--layout", "wide")
        self.assertIn("form factors   reused", run.out)
        self.assertEqual((self.folder / "t.h5").read_bytes(), before)
        self.assertRegex(run.out, r"\| walls +\| +0\.917")
        self.assertIn("surface left_wall/red is in group walls already", run.out)
        report = self.report("factors", "t.h5", "--group", "walls=*wall/*")
        pairs = {(p["from"], p["to"]): p["form_factor"] for p in report["table"]["pairs"]}
        truth = Truth(self.folder / "t.h5", [WALLS])
        self.assert_close(pairs["walls", "walls"], truth.factors[0, 0])

    def test_threads_change_no_bit_of_tables(self):
        self.run_program("factors", DATA / "cornell-box.obj", "--patches", 400, "--method", "exact",
                         "-o", "t.h5")
        self.run_program("factors", "t.h5", "--threads", 2, "-o", "a.csv", "-o", "a.txt")
        run = self.run_program("factors", "t.h5", "--threads", 1, "-o", "b.csv", "-o", "b.txt")
        self.assertIn("form factors   reused", run.out)
        for name in ("csv", "txt"):
            self.assertEqual((self.folder / f"a.{name}").read_bytes(),
                             (self.folder / f"b.{name}").read_bytes())

    def test_energyplus_has_every_pair_of_the_zone(self):
        run = self.run_program(*ROOM, "-o", "t.idf", "--zone", "Room 1", "-o", "t.h5")
        self.assertIn("EnergyPlus takes the zone to be closed", run.err)
        truth = Truth(self.folder / "t.h5")
        text = "\n".join(line.split("!")[0] for line in
                         (self.folder / "t.idf").read_text().splitlines())
        objects = [o for o in text.split(";") if o.strip()]
        self.assertEqual(len(objects), 1)
        fields = [field.strip() for field in objects[0].split(",")]
        self.assertEqual(fields[:2], ["ZoneProperty:UserViewFactors:BySurfaceName", "Room 1"])
        n = len(truth.names)
        self.assertEqual(len(fields), 2 + 3 * n * n)
        for k in range(n * n):
            a, b, value = fields[2 + 3 * k:5 + 3 * k]
            self.assertEqual((a, b), (truth.names[k // n], truth.names[k % n]))
            self.assert_close(float(value), truth.factors[k // n, k % n])

    def test_view3d_has_areas_factors_and_emissivities(self):
        self.run_program("factors", "box.obj", "--patches", 60, "--method", "exact", "-o", "t.vf",
                         "-o", "t.h5")
        truth = Truth(self.folder / "t.h5")
        enclosure, area, factors, emissivity = read_view3d(self.folder / "t.vf")
        self.assertEqual(enclosure, 1)
        self.assert_close(area, truth.area)
        self.assert_close(factors, truth.factors)
        # Kd of walls is .5 .6 .7, that of the lamp .2: means over bands.
        self.assert_close(emissivity, [1 - .6, 1 - .2])
        self.run_program("factors", "t.h5", "--between", "patches", "-o", "p.vf")
        enclosure, area, factors, emissivity = read_view3d(self.folder / "p.vf")
        self.assertEqual(factors.shape, truth.patches.shape)
        self.assert_close(factors, truth.patches.toarray())

    def test_triplets_hold_the_matrix_with_sky_and_backs(self):
        self.run_program(*ROOM, "-o", "t.txt", "-o", "t.hdf5", "-o", "t.h5", "-o", "t.csv",
                         "--between", "patches", "--layout", "long")
        truth = Truth(self.folder / "t.h5")
        n = truth.patches.shape[0]
        i, j, value = numpy.loadtxt(self.folder / "t.txt", unpack=True)
        whole = scipy.sparse.coo_matrix((value, (i.astype(int), j.astype(int))), (n, n + 2))
        wanted = numpy.column_stack([truth.patches.toarray(), truth.sky_of_patches,
                                     truth.backs_of_patches])
        self.assert_close(whole.toarray(), wanted)
        with h5py.File(self.folder / "t.hdf5") as file:
            again = scipy.sparse.coo_matrix(
                (file["form_factor"][()], (file["row"][()], file["column"][()])),
                file.attrs["shape"])
            self.assert_close(again.toarray(), truth.patches.toarray())
            self.assert_close(file["sky"][()], truth.sky_of_patches)
            self.assertEqual(len(file["names"][()]), n)
            self.assertEqual(file["area"].attrs["unit"], b"m^2")
        header, rows = read_csv(self.folder / "t.csv")
        entries = [row for row in rows if row[1] not in ("sky", "backs")]
        self.assertEqual(len(entries), truth.patches.nnz)
        self.assertEqual(len(rows), truth.patches.nnz + 2 * n)

    def test_tables_of_hemicubes_have_reciprocity_but_no_error(self):
        self.run_program("factors", DATA / "cornell-box.obj", "--patches", 60, "--method",
                         "hemicube", "--resolution", 32, "-o", "t.csv", "-o", "t.h5")
        truth = Truth(self.folder / "t.h5")
        header, rows = read_csv(self.folder / "t.csv")
        self.assertNotIn("error", header)
        exchange = truth.area[:, None] * truth.factors
        self.assert_close([float(row[-1]) for row in rows],
                          abs(exchange - exchange.T).max(axis=1))
        self.run_program("factors", "t.h5", "--layout", "long", "-o", "t.csv", "-o", "t.json")
        header, rows = read_csv(self.folder / "t.csv")
        self.assertEqual(header, ["from", "to", "area_m2", "form_factor", "reciprocity_m2"])
        self.assertTrue(all(len(row) == 5 for row in rows))

    def test_names_with_commas_are_quoted(self):
        self.run_program("factors", "box.obj", "--patches", 30, "--group", 'a, "b"=room*', "-o",
                         "t.csv")
        header, rows = read_csv(self.folder / "t.csv")
        self.assertEqual(rows[0][0], 'a, "b"')
        self.assertEqual(header[2], 'a, "b"')

    def test_options_that_do_not_fit_are_refused(self):
        small = ["factors", "box.obj", "--patches", 30]
        self.refuse(*small, "--group", "a=up*", words=["--group a=up*", "room/wall", "ceiling/lamp"])
        self.refuse(*small, "--layout", "long", words=["--layout", "--between"])
        self.refuse(*small, "--zone", "z", words=["--zone", ".idf"])
        self.refuse(*small, "--between", "surfaces", "--group", "a=*", words=["--group"])
        self.refuse(*small, "--between", "patches", "-o", "t.idf", words=["t.idf", "--between"])
        self.refuse(*small, "--sky-name", "room/wall", "-o", "t.csv", words=["--sky-name"])

    def test_names_are_refused_before_form_factors_are_computed(self):
        # A run that computed them would have said so, and left k.h5.
        small = ["factors", "box.obj", "--patches", 30, "-o", "k.h5"]
        for arguments, words in [
                (["--group", "sky=*wall*", "-o", "k.csv"], ["k.csv", "is called sky"]),
                (["--group", "sky=*wall*"], ["is called sky"]),
                (["--group", "backs=*wall*", "-o", "k.json"], ["k.json", "is called backs"]),
                (["--sky-name", "ceiling/lamp", "-o", "k.md"], ["k.md", "ceiling/lamp"]),
                (["--between", "patches", "-o", "k.idf"], ["k.idf", "--between patches"]),
                (["--group", "a, b=*wall*", "-o", "k.idf"], ["k.idf", "'a, b'", "EnergyPlus"]),
                (["--group", "CEILING/LAMP=*wall*", "-o", "k.idf"], ["k.idf", "ignores case"]),
                (["--zone", "a;b", "-o", "k.idf"], ["k.idf", "'a;b'"])]:
            self.refuse(*small, *arguments, words=words)
            run = self.run_program(*small, *arguments, code=2)
            self.assertNotIn("about", run.out, "planned")

    def test_a_failed_table_keeps_the_form_factors(self):
        # View3D's readers divide by areas; only the mesh tells which rows have none.
        self.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\n"
                   "o a\nf 1 2 3 4\no line\nf 1 2 5\n")
        run = self.run_program("factors", "flat.obj", "--patches", 8, "-o", "k.h5", "-o", "k.vf", code=2)
        self.assertIn("no area", run.err)
        self.assertIn("k.h5", self.files())
        self.assertNotIn("k.vf", self.files())
        again = self.report("factors", "k.h5", "-o", "k.csv")
        self.assertEqual(again["stages"]["form_factors"]["action"], "reused")


if __name__ == "__main__":
    unittest.main()
