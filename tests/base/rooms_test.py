"""A file of a room compiles with headers of the rooms that it knows, and with no others."""
import json
import os
import pathlib
import shlex
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["RADIOSITY_BUILD_DIR"])
ROOT = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"])

# (a file of a room, a header that it may include, headers that it may not)
CASES = [
    ("base/parallel.cpp", "radiosity/base.h", ["scene/text.h", "radiosity/scene.h"]),
    ("scene/text.cpp", "base/finite.h", ["mesh/winding.h", "radiosity/patch_mesh.h"]),
    ("mesh/winding.cpp", "scene/text.h", ["matrix/run_row.h", "radiosity/form_factors.h"]),
    ("matrix/run_row.cpp", "base/finite.h", ["mesh/winding.h", "radiosity/patch_mesh.h"]),
    ("formfactor/exact/assembly/error_figure.cpp", "formfactor/view_scene.h",
     ["formfactor/hemicube/hemicube.h", "radiosity/solve.h"]),
    ("formfactor/hemicube/hemicube.cpp", "formfactor/exact/elements/elements.h",
     ["radiosity/gather.h"]),
    ("solve/solve.cpp", "radiosity/form_factors.h", ["radiosity/gather.h", "radiosity/render.h"]),
    ("heat/nodes.cpp", "radiosity/form_factors.h", ["radiosity/gather.h", "radiosity/results.h"]),
    ("elements/field_builder.cpp", "formfactor/rays/point_rays.h",
     ["radiosity/solve.h", "radiosity/render.h"]),
    ("gather/gather.cpp", "formfactor/hemicube/hemicube.h",
     ["formfactor/form_factors.cpp", "radiosity/results.h"]),
    ("render/legend.cpp", "radiosity/patch_mesh.h", ["radiosity/solve.h", "matrix/run_row.h"]),
    ("lightmap/charts.cpp", "radiosity/render.h", ["results/glb.h", "radiosity/gather.h"]),
    ("results/results_file.cpp", "radiosity/gather.h", ["radiosity/compare.h"]),
    ("tables/csv.cpp", "results/checked_file.h", ["radiosity/compare.h", "radiosity/pipeline.h"]),
    ("pipeline/stages.cpp", "radiosity/results.h", ["radiosity/compare.h", "radiosity/page.h"]),
    ("page/header.cpp", "results/lit_vertices.h", ["radiosity/compare.h"]),
    ("cli/words.cpp", "base/figure_text.h", ["mesh/winding.h", "scene/text.h"]),
]


def commands():
    """The compiler's command for every source of the library and the program (tests compile some of
    these too)."""
    database = json.loads((BUILD / "compile_commands.json").read_text())
    return {entry["file"]: (shlex.split(entry["command"]), entry["directory"])
            for entry in database if " -o tests/" not in entry["command"]}


class Rooms(unittest.TestCase):
    def compiles(self, source, header):
        command, directory = self.commands[str(ROOT / "src" / source)]
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
        for source, known, others in CASES:
            with self.subTest(source=source):
                self.assertTrue(self.compiles(source, known), known)
                for header in others:
                    self.assertTrue((ROOT / "src" / header).exists()
                                    or (ROOT / "include" / header).exists(), header)
                    self.assertFalse(self.compiles(source, header), header)


if __name__ == "__main__":
    unittest.main()
