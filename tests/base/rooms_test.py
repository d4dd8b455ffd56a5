"""A file of a room compiles with headers of the rooms that it knows, and with no others; only the
command line knows how it spells options."""
import json
import os
import pathlib
import re
import shlex
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["RADIOSITY_BUILD_DIR"])
ROOT = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"])

# (a room, a header that it may include, headers that it may not)
CASES = [
    ("base", "radiosity/base.h", ["scene/text.h", "radiosity/scene.h"]),
    ("scene", "base/finite.h", ["mesh/bodies/winding.h", "radiosity/patch_mesh.h"]),
    ("mesh", "scene/text.h", ["matrix/run_row.h", "radiosity/form_factors.h"]),
    ("matrix", "base/finite.h", ["mesh/bodies/winding.h", "radiosity/patch_mesh.h"]),
    ("visibility", "mesh/bodies/winding.h",
     ["formfactor/view_scene.h", "radiosity/form_factors.h"]),
    ("formfactor_exact", "visibility/elements/elements.h",
     ["formfactor/hemicube/hemicube.h", "radiosity/solve.h"]),
    ("formfactor_hemicube", "visibility/elements/elements.h",
     ["radiosity/gather.h"]),
    ("solve", "radiosity/form_factors.h",
     ["formfactor/rays/embree_scene.h", "radiosity/gather.h", "radiosity/render.h"]),
    ("heat", "radiosity/form_factors.h",
     ["formfactor/rays/embree_scene.h", "radiosity/gather.h", "radiosity/results.h"]),
    ("elements", "formfactor/rays/point_rays.h",
     ["formfactor/exact/occluded/occluded_pairs.h", "radiosity/solve.h", "radiosity/render.h"]),
    ("gather", "formfactor/hemicube/hemicube.h",
     ["formfactor/form_factors.cpp", "radiosity/results.h"]),
    ("gl", "formfactor/hemicube/gpu_eye.h", ["gather/passes.h", "radiosity/solve.h"]),
    ("render", "formfactor/rays/point_rays.h", ["radiosity/solve.h", "radiosity/gather.h"]),
    ("lightmap", "radiosity/render.h", ["results/glb.h", "radiosity/gather.h"]),
    ("results", "radiosity/gather.h", ["radiosity/compare.h"]),
    ("tables", "results/checked_file.h", ["radiosity/compare.h", "radiosity/pipeline.h"]),
    ("interchange", "lightmap/face_triangles.h", ["radiosity/results.h", "radiosity/pipeline.h"]),
    ("pipeline", "radiosity/results.h", ["radiosity/compare.h", "radiosity/page.h"]),
    ("page", "results/lit_vertices.h", ["radiosity/compare.h"]),
    ("cli", "base/figure_text.h", ["mesh/bodies/winding.h", "scene/text.h"]),
]


def commands():
    """room -> (the compiler's command for its files, the folder it is given in)."""
    result = {}
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        if found := re.search(r" -o CMakeFiles/radiosity_(\w+)\.dir/", entry["command"]):
            result[found[1]] = (shlex.split(entry["command"]), entry["directory"])
    return result


class Rooms(unittest.TestCase):
    def compiles(self, room, header):
        command, directory = self.commands[room]
        command = command[:command.index("-o")] + ["-w", "-fsyntax-only", "-x", "c++"]
        with tempfile.NamedTemporaryFile("w", suffix=".cpp") as probe:
            probe.write(f'#include "{header}"\n')
            probe.flush()
            done = subprocess.run(command + [probe.name], cwd=directory, capture_output=True,
                                  text=True)
        if done.returncode != 0:
            self.assertIn(f"fatal error: {header}: No such file", done.stderr)
        return done.returncode == 0

    def test_only_headers_of_known_rooms_are_found(self):
        self.commands = commands()
        for room, known, others in CASES:
            with self.subTest(room=room):
                self.assertTrue(self.compiles(room, known), known)
                for header in others:
                    self.assertTrue((ROOT / "src" / header).exists()
                                    or (ROOT / "include" / header).exists(), header)
                    self.assertFalse(self.compiles(room, header), header)

    def test_messages_leave_the_spelling_of_options_to_faces(self):
        # Not options of ours, or a whole command.
        others = re.compile("<!--radiosity-data-->|gunzip --keep|radiosity info --devices")
        for file in sorted([*ROOT.glob("include/**/*.h"), *ROOT.glob("src/**/*.h"),
                            *ROOT.glob("src/**/*.cpp")]):
            if ROOT / "src/cli" in file.parents:
                continue
            code = re.sub("//.*", "", file.read_text())
            for text in re.findall(r'"(?:[^"\\\n]|\\.)*"', code):
                self.assertNotRegex(others.sub("", text), "--[a-z]", f"{file}: call spelled()")


if __name__ == "__main__":
    unittest.main()
