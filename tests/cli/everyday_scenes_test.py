"""Scenes of the kinds that people have, with their trouble, go through info, mesh and factors."""

import sys
import unittest
from pathlib import Path

import h5py
import numpy as np

from cli_runner import CliTest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "everyday_scenes"))
import generators  # noqa: E402  (a folder of scripts, not a package)

# Sums over thousands of areas of very different sizes, each rounded at 1e-16: 1e-12 would do, but
# if coordinates are a million times a face's size, its edges keep ten digits.
AREA = 1e-9

# Dropped areas are reported with six digits: half a unit of the last one, at most.
REPORT_DIGITS = 5e-6

# Sums of rows whose entries are rounded to single precision.
ROUNDING = 2e-6


def everything_is_finite(file):
    """Names of all datasets of numbers with a value that is none."""
    bad = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f":
            if not np.isfinite(item[()]).all():
                bad.append(name)

    file.visititems(visit)
    return bad


class EverydayScenes(CliTest):
    def check(self, maker, faces, welded=0.0):
        scene = maker(faces)
        path = scene.write(self.folder / maker.__name__).name
        self.run_program("info", path)
        report = self.report("mesh", path, "--patches", "200", "-o", "m.h5")
        self.check_areas(scene, report["mesh"]["surfaces"])
        self.run_program("factors", path, "--patches", "200", "-o", "f.h5")
        with h5py.File(self.folder / "f.h5") as file:
            self.assertEqual(everything_is_finite(file), [])
            self.check_rows(file, welded)

    def check_areas(self, scene, surfaces):
        """Each square metre of the file is in a patch or in the account of dropped areas."""
        with h5py.File(self.folder / "m.h5") as file:
            kept = file["mesh/area"][:][file["mesh/side"][:] == 0].sum()
        dropped = [s[key] for s in surfaces for key in
                   ("buried_m2", "overlapped_m2", "degenerate_m2")]
        least, most = scene.area()
        rounding = AREA * most + REPORT_DIGITS * np.abs(dropped).sum()
        self.assertGreater(kept, 0)
        self.assertGreater(kept + sum(dropped), least - rounding)
        self.assertLess(kept + sum(dropped), most + rounding)

    def check_rows(self, file, welded):
        """Fronts, backs and sky of every row: 1. Errors of a row's N entries whose squares sum up
        to at most its error figure's square sum up to at most the root of N times it. `welded`:
        share of a row that may be lost by welding."""
        group = file["form_factors"]
        accounts = [group[name][:] for name in ("fronts", "backs", "sky")]
        area = group["area"][:]
        figure = group["error"][:] if "error" in group else np.zeros(len(area))
        allowed = ROUNDING + welded + np.sqrt(len(area)) * figure
        missing = np.abs(sum(accounts) - 1)[area > 0]
        self.assertLess((missing / allowed[area > 0]).max(), 1)
        for account in accounts:
            self.assertGreater((account + allowed).min(), 0)

    def test_a_cad_export_is_meshed_and_computed(self):
        self.check(generators.cad_export, 250)

    def test_a_doubled_house_is_meshed_and_computed(self):
        self.check(generators.doubled_house, 50)

    def test_photogrammetry_is_meshed_and_computed(self):
        self.check(generators.photogrammetry, 100)

    def test_a_city_is_meshed_and_computed(self):
        self.check(generators.city, 200)

    def test_linked_duplicates_are_meshed_and_computed(self):
        self.check(generators.linked_duplicates, 220)

    def test_text_geometry_is_meshed_and_computed(self):
        self.check(generators.text_geometry, 300)

    def test_leaf_cards_are_meshed_and_computed(self):
        self.check(generators.leaf_cards, 80)

    def test_a_terrain_is_meshed_and_computed(self):
        self.check(generators.terrain, 200)

    def test_a_sphere_is_meshed_and_computed(self):
        self.check(generators.sphere, 300)

    def test_a_room_a_million_units_away_is_meshed_and_computed(self):
        self.check(generators.million_units_away, 100)

    def test_rooms_two_million_units_apart_are_meshed_and_computed(self):
        # Lengths below 0.2 are coincident here: slabs up to 3e-3 high may lie in the floor of a room
        # that is 3 high, or not, patch by patch.
        self.check(generators.two_million_units_apart, 100, welded=1e-3)
        said = self.run_program("mesh", "two_million_units_apart.obj", "-o", "again.h5")
        self.assertIn("m from all others: lengths below 0.2 m", said.err)


if __name__ == "__main__":
    unittest.main()
