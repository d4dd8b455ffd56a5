"""One scene in every format of named meshes: areas, names and form factors are those of its OBJ."""

import subprocess
import sys
import unittest

import numpy
from scipy.io import mmread

import mesh_files
from cli_runner import DATA, PROGRAM, CliTest, limit

FORMATS = {
    "a.vs3": [mesh_files.to_view3d],
    "a.msh": [mesh_files.to_gmsh2, mesh_files.to_gmsh4, lambda m: mesh_files.to_gmsh2(m, binary=True),
              lambda m: mesh_files.to_gmsh4(m, binary=True)],
    "a.inp": [mesh_files.to_inp],
    "a.ply": [lambda m, e=e: mesh_files.to_ply(m, e)
              for e in ("ascii", "binary_little_endian", "binary_big_endian")],
    "a.vtk": [lambda m, b=b, d=d, v=v: mesh_files.to_vtk(m, b, d, v)
              for b in (False, True) for d in ("POLYDATA", "UNSTRUCTURED_GRID") for v in ("3.0", "5.1")],
    "a.vtp": [lambda m, o=o: mesh_files.to_vtk_xml(m, "PolyData", **o) for o in (
        {}, {"form": "binary", "header": "UInt32"}, {"form": "binary", "compressed": True},
        {"form": "appended"}, {"form": "appended", "encoding": "raw", "compressed": True})],
    "a.vtu": [lambda m, o=o: mesh_files.to_vtk_xml(m, "UnstructuredGrid", **o) for o in (
        {}, {"form": "binary"}, {"form": "appended", "compressed": True, "header": "UInt32"},
        {"form": "appended", "encoding": "raw"})],
}


class MeshFormats(CliTest):
    def areas(self, file):
        surfaces = self.report("info", file)["scene"]["surfaces"]
        return {s["name"]: s["area_m2"] for s in surfaces}

    def factors(self, file):
        """Form factors between the faces of the file."""
        self.run_program("factors", file, "--faces-as-patches", "--tolerance", "1e-3", "-o", "f.mtx")
        return mmread(self.folder / "f.mtx").toarray()

    def test_every_format_is_the_same_scene(self):
        mesh = mesh_files.from_obj(DATA / "cornell-box-closed.obj")
        # PLY and VTK number their groups here.
        numbered = mesh_files.Mesh(mesh.points, {f"group {k}": faces for k, faces in
                                                 enumerate(mesh.groups.values(), 1)})
        expected = {}
        for named, one in [(True, mesh), (False, numbered)]:
            (self.folder / "a.obj").write_bytes(mesh_files.to_obj(one))
            areas = {name.split("/")[0]: area for name, area in self.areas("a.obj").items()}
            expected[named] = areas, self.factors("a.obj")
        for name, writers in FORMATS.items():
            areas, factors = expected[name in ("a.vs3", "a.msh", "a.inp")]
            for k, write in enumerate(writers):
                with self.subTest(name=name, writer=k):
                    (self.folder / name).write_bytes(write(mesh))
                    self.assertEqual(self.areas(name), areas)
                    # To the bit: faces and names are the same, in the same order.
                    numpy.testing.assert_array_equal(self.factors(name), factors)

    def test_every_format_takes_a_unit(self):
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
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, timeout=limit(60),
                             check=False)
        if run.returncode != 0:
            self.assertEqual(run.stderr.count(b"\n"), 1, run.stderr)
        return run.returncode

    def test_cut_off_files_are_refused(self):
        """At many lengths: one line, no crash."""
        for name, writers in FORMATS.items():
            for k, write in enumerate(writers):
                whole = write(self.MESH)
                # Without its groups a legacy VTK file is whole, too.
                end = len(whole) - 40 if name != "a.vtk" else whole.find(b"CELL_DATA") - 10
                for length in range(0, end, max(1, len(whole) // 12)):
                    (self.folder / name).write_bytes(whole[:length])
                    with self.subTest(name=name, writer=k, length=length):
                        self.refuse("info", name, words=[name])

    def test_damaged_files_do_no_harm(self):
        """Files with replaced bytes: read, or refused in one line."""
        random = numpy.random.default_rng(7)
        for name, writers in FORMATS.items():
            for write in writers:
                whole = write(self.MESH)
                for _ in range(5):
                    damaged = bytearray(whole)
                    for place in random.integers(0, len(whole), 3):
                        damaged[place] = random.integers(0, 256)
                    (self.folder / name).write_bytes(bytes(damaged))
                    code = self.exit_code("info", name)
                    with self.subTest(name=name, damaged=bytes(damaged)):
                        self.assertIn(code, [0, 2])


if __name__ == "__main__":
    sys.exit(unittest.main())
