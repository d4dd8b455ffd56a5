"""One scene in every format of named meshes: areas, names and form factors are those of its OBJ."""

import subprocess
import sys
import unittest

import numpy
from scipy.io import mmread

import mesh_files
from cli_runner import DATA, PROGRAM, CliTest

FORMATS = {
    "a.vs3": [mesh_files.to_view3d],
    "a.msh": [mesh_files.to_gmsh2, mesh_files.to_gmsh4, lambda m: mesh_files.to_gmsh2(m, binary=True),
              lambda m: mesh_files.to_gmsh4(m, binary=True)],
    "a.inp": [mesh_files.to_inp],
}


class MeshFormats(CliTest):
    def areas(self, file):
        surfaces = self.report("info", file)["scene"]["surfaces"]
        return {s["name"]: s["area_m2"] for s in surfaces}

    def row_sums(self, file):
        """Form factors between the faces as they stand in the file."""
        self.run_program("factors", file, "--faces-as-patches", "--tolerance", "1e-4", "-o", "f.mtx")
        return mmread(self.folder / "f.mtx").toarray()

    def expected_areas(self, areas, name):
        """PLY and VTK have numbers for groups here, in the order of the OBJ."""
        if name.split(".")[1] in ("vs3", "msh", "inp"):
            return areas
        return {f"group {k}": area for k, area in enumerate(areas.values(), 1)}

    def test_every_format_is_the_same_scene(self):
        mesh = mesh_files.from_obj(DATA / "cornell-box-closed.obj")
        (self.folder / "a.obj").write_bytes(mesh_files.to_obj(mesh))
        areas = {name.split("/")[0]: area for name, area in self.areas("a.obj").items()}
        factors = self.row_sums("a.obj")
        for name, writers in FORMATS.items():
            for k, write in enumerate(writers):
                with self.subTest(name=name, writer=k):
                    (self.folder / name).write_bytes(write(mesh))
                    self.assertEqual(self.areas(name), self.expected_areas(areas, name))
                    # Faces stand in the order of the OBJ, but for Gmsh's blocks of one kind.
                    found = self.row_sums(name)
                    if name == "a.msh":
                        order = numpy.argsort(found.sum(axis=0)), numpy.argsort(factors.sum(axis=0))
                        numpy.testing.assert_allclose(found[numpy.ix_(order[0], order[0])].sum(axis=1),
                                                      factors[numpy.ix_(order[1], order[1])].sum(axis=1))
                    else:
                        numpy.testing.assert_array_equal(found, factors)

    def test_units(self):
        mesh = mesh_files.Mesh([(0, 0, 0), (1000, 0, 0), (0, 1000, 0)], {"plate": [[0, 1, 2]]})
        for name, writers in FORMATS.items():
            with self.subTest(name=name):
                (self.folder / name).write_bytes(writers[0](mesh))
                scene = self.report("info", name, "--unit", "mm")["scene"]
                self.assertEqual([scene["surfaces"][0]["area_m2"], scene["upper_m"]], [0.5, [1, 1, 0]])

    def test_names_are_unique_and_take_settings(self):
        mesh = mesh_files.Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
                               {"floor slab": [[0, 1, 2]], "lamp": [[0, 3, 1]], "walls": [[0, 2, 3], [1, 3, 2]]})
        for name, writers in FORMATS.items():
            if name == "a.vs3":
                continue  # names without blanks
            with self.subTest(name=name):
                (self.folder / name).write_bytes(writers[0](mesh))
                names = [s["name"] for s in self.report("info", name)["scene"]["surfaces"]]
                if name in ("a.msh", "a.inp"):
                    self.assertEqual(names, ["floor slab", "lamp", "walls"])
                run = self.run_program("info", name, "--set", f"{names[1]}.reflectance=.25")
                self.assertIn(f"{names[1]}: reflectance 0.5 -> 0.25", run.out)


class BrokenMeshes(CliTest):
    MESH = mesh_files.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], {"plate": [[0, 1, 2, 3]]})

    def exit_code(self, *arguments):
        """A run that ends by itself: with a summary, or with one line."""
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, timeout=60,
                             check=False)
        if run.returncode != 0:
            self.assertEqual(run.stderr.count(b"\n"), 1, run.stderr)
        return run.returncode

    def test_cut_off_files_are_refused(self):
        """At every length: one line, no crash, or what is left is a whole file."""
        for name, writers in FORMATS.items():
            for k, write in enumerate(writers):
                whole = write(self.MESH)
                for length in range(0, len(whole) - 40, 7):
                    (self.folder / name).write_bytes(whole[:length])
                    with self.subTest(name=name, writer=k, length=length):
                        self.refuse("info", name, words=[name])

    def test_damaged_files_do_no_harm(self):
        """Bytes that are replaced: read, or refused in one line."""
        random = numpy.random.default_rng(7)
        for name, writers in FORMATS.items():
            for write in writers:
                whole = write(self.MESH)
                for _ in range(12):
                    damaged = bytearray(whole)
                    for place in random.integers(0, len(whole), 3):
                        damaged[place] = random.integers(0, 256)
                    (self.folder / name).write_bytes(bytes(damaged))
                    code = self.exit_code("info", name)
                    with self.subTest(name=name, damaged=bytes(damaged)):
                        self.assertIn(code, [0, 2])


if __name__ == "__main__":
    sys.exit(unittest.main())
