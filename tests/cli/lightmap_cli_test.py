"""--lightmap on the command line: files, report and refusals."""

import json
import shutil
import struct
import unittest

from cli_runner import DATA, SMALL, CliTest

MAP = ["--lightmap", "map.exr", "--lightmap-size", "64"]
# In this room so few hemicubes balance energy only if both estimates of a pair are merged.
ROOM = [*SMALL, "--symmetrize"]


def glb_document(path):
    """The JSON of a binary glTF file."""
    content = path.read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)
    return json.loads(content[20:20 + length])


class LightmapCli(CliTest):
    def test_a_lightmap_has_an_image_a_mesh_and_a_report(self):
        report = self.report("solve", DATA / "blender-room.glb", *ROOM, *MAP, "-o", "baked.glb")
        self.assertEqual(self.files(), ["baked.glb", "box.mtl", "box.obj", "map.exr", "run.json"])
        lightmap = report["lightmap"]
        self.assertEqual(lightmap["texcoords"], "TEXCOORD_1")
        self.assertAlmostEqual(lightmap["inside"] + lightmap["padding"] + lightmap["unused"], 1)
        self.assertIn("Drum/Blue paint", self.run_program("info", "baked.glb").out)

    def test_a_results_file_gives_a_lightmap_beside_a_picture(self):
        self.run_program("solve", "box.obj", *SMALL, "-o", "box.h5")
        run = self.run_program("render", "box.h5", *MAP, "-o", "p.png", "-o", "baked.glb", "--width",
                               "32", "--lightmap-shows", "radiosity")
        self.assertIn("lightmap, radiosity, W/m^2", run.out)
        self.assertTrue((self.folder / "p.png").exists())

    def test_a_results_file_keeps_what_the_scenes_own_file_has(self):
        shutil.copy(DATA / "blender-room.glb", self.folder / "room.glb")
        self.run_program("solve", "room.glb", *ROOM, "-o", "room.h5")
        self.run_program("render", "room.glb", *ROOM, *MAP, "-o", "scene.glb")
        self.run_program("render", "room.h5", *MAP, "-o", "results.glb")
        scene, results = (glb_document(self.folder / name) for name in ("scene.glb", "results.glb"))
        for part in ("nodes", "materials", "cameras"):
            self.assertEqual(results.get(part), scene.get(part), part)
        attributes = results["meshes"][0]["primitives"][0]["attributes"]
        self.assertIn("NORMAL", attributes)
        self.assertIn("TEXCOORD_1", attributes)

    def test_a_results_file_says_what_is_lost_without_the_scenes_own_file(self):
        shutil.copy(DATA / "blender-room.glb", self.folder / "room.glb")
        self.run_program("solve", "room.glb", *ROOM, "-o", "room.h5")
        (self.folder / "room.glb").unlink()
        run = self.run_program("render", "room.h5", *MAP, "-o", "results.glb")
        self.assertIn("without the textures, normals and cameras of room.glb, which is not there", run.err)
        # Another scene under the same name is not taken for it.
        shutil.copy(self.folder / "results.glb", self.folder / "room.glb")
        run = self.run_program("render", "room.h5", *MAP, "-o", "other.glb")
        self.assertIn("room.glb, which cannot be used", run.err)
        self.assertTrue((self.folder / "other.glb").exists())

    def test_impossible_lightmaps_are_refused_before_any_work(self):
        solve = ["solve", "box.obj", *SMALL]
        glb = ["-o", "baked.glb"]
        self.refuse(*solve, *MAP, words=["--lightmap map.exr", "add -o FILE.glb"])
        self.refuse(*solve, *glb, "--lightmap", "map.png", words=["map.png", "writes .exr"])
        self.refuse(*solve, *MAP, *glb, "--elements", "off", words=["leave out --elements off"])
        self.refuse(*solve, *glb, "--lightmap-size", "64", words=["add --lightmap FILE.exr"])
        self.refuse(*solve, *glb, "--lightmap", "map.exr", "--lightmap-size", "9999",
                    words=["--lightmap-size: 9999 texels is out of range; 16 to 4096"])
        self.refuse(*solve, *MAP, *glb, "--memory-limit", "100k",
                    words=["--lightmap-size 64: the map takes", "--memory-limit allows"])
        self.refuse("render", "box.obj", "--lightmap", "p.exr", "-o", "p.exr", *glb,
                    words=["p.exr: named twice"])
        self.refuse("render", "box.obj", "--flat", *MAP, *glb, words=["leave out --flat"])

    def test_a_map_too_small_for_its_charts_is_refused(self):
        self.refuse("solve", DATA / "cornell-box.obj", *SMALL, "--element-tolerance", "0.5", "--lightmap",
                    "map.exr", "--lightmap-size", "16", "-o", "baked.glb",
                    words=["a lightmap of 16 x 16 texels has no room for", "would do"])


if __name__ == "__main__":
    unittest.main()
