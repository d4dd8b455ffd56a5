"""Models that others made, of Debian's package for Assimp's tests: each is read or refused in a line,
and those that are read have finite form factors that account for all of the view."""

import re
import subprocess
import unittest
from pathlib import Path

import h5py
import numpy as np

from cli_runner import PROGRAM, CliTest, limit

MODELS = Path("/usr/share/assimp/models")
READ = {".obj", ".gltf", ".glb", ".stl", ".ply", ".off", ".dae", ".fbx", ".3ds", ".ifc", ".3mf", ".dxf"}

# A few of each format, of at most some thousand faces: spiders, a duck, a rock, boxes.
MESHED = [
    "OBJ/spider.obj", "OBJ/concave_polygon.obj", "OFF/Wuson.off", "STL/Spider_binary.stl",
    "PLY/cube.ply", "3DS/fels.3ds", "3MF/box.3mf", "Collada/duck.dae", "FBX/spider.fbx", "DXF/wuson.dxf",
    "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", "glTF2/textureTransform/TextureTransformTest.gltf",
]


class ModelsOfOthersTest(CliTest):
    def test_each_model_is_read_or_refused_in_a_line(self):
        models = sorted(p for p in MODELS.rglob("*") if p.suffix.lower() in READ and p.is_file())
        self.assertGreater(len(models), 100, "is assimp-testmodels installed? see tools/setup")
        read = 0
        for model in models:
            with self.subTest(model.relative_to(MODELS)):
                run = subprocess.run([PROGRAM, "info", model], capture_output=True, text=True,
                                     timeout=limit(60), check=False)
                if run.returncode == 0:
                    read += 1
                    continue
                self.assertEqual(run.returncode, 2)
                self.assertRegex(run.stderr, r"\Aradiosity: [^\n]*\n\Z")
                self.assertIn(str(model), run.stderr)
        # 112 of 158 in Debian 12; the others are of glTF 1, broken on purpose, or points alone.
        self.assertGreater(read, len(models) // 2)

    def test_a_file_at_which_assimp_takes_all_memory_is_refused_in_a_line(self):
        """A byte of a count."""
        broken = bytearray((MODELS / "3DS/test1.3ds").read_bytes())
        broken[10555] = 106
        (self.folder / "a.3ds").write_bytes(broken)
        self.assertEqual(self.refuse("info", "a.3ds"),
                         "radiosity: a.3ds: needs far more memory than its size explains: Assimp, the library that "
                         "reads this format, gave up; export it again, or save it as glTF or OBJ")

    def test_a_building_has_its_names_materials_and_metres(self):
        file = MODELS / "IFC/AC14-FZK-Haus.ifc"
        scene = self.report("info", file)["scene"]
        area = {surface["name"].split("_")[1]: surface["area_m2"] for surface in scene["surfaces"]}
        self.assertAlmostEqual(area["Bodenplatte"], 2 * 12 * 10 + 2 * (12 + 10) * 0.2, 4)  # a slab
        windows = [s["name"] for s in scene["surfaces"] if re.fullmatch("IfcWindow_.*/Glas", s["name"])]
        self.assertEqual(len(windows), file.read_text(errors="replace").count("IFCWINDOW("))
        # Of the many materials "Glas" of the file, all alike, there is one.
        self.assertEqual([m["name"] for m in scene["materials"] if "Glas" in m["name"]], ["Glas"])

    def test_draco_packs_the_same_engine(self):
        def areas(name):
            scene = self.report("info", MODELS / "glTF2" / name)["scene"]
            return {surface["name"]: surface["area_m2"] for surface in scene["surfaces"]}
        plain = areas("2CylinderEngine-glTF-Binary/2CylinderEngine.glb")
        packed = areas("draco/2CylinderEngine.gltf")
        self.assertEqual(list(packed), list(plain))
        for name, area in plain.items():
            # Positions are rounded to 1/2048 of a part's extent, thin parts have 5 times that.
            self.assertAlmostEqual(packed[name] / area, 1, delta=0.0025, msg=name)

    def test_form_factors_account_for_all_of_the_view(self):
        for model in MESHED:
            with self.subTest(model):
                self.run_program("factors", str(MODELS / model), "--patches", "60", "--method", "rays",
                                 "--tolerance", "5e-2", "-o", "f.h5")
                with h5py.File(self.folder / "f.h5") as results:
                    factors = results["form_factors"]
                    rows = np.add.reduceat(np.append(factors["data"][()], 0.0), factors["indptr"][:-1])
                    rows[np.diff(factors["indptr"]) == 0] = 0
                    seen = rows + factors["sky"][()] + factors["backs"][()]
                # Merging the two estimates of a pair moves a row by as much as the rays' error.
                self.assertTrue(np.all(np.abs(seen - 1) < 0.2), seen)


if __name__ == "__main__":
    unittest.main()
