"""Meshes of other packages become scenes and back."""

import types

import numpy as np
import pytest

import radiosity as rad
from conftest import box

meshio = pytest.importorskip("meshio")


def test_meshio_sets_become_surfaces_in_order():
    vertices, faces = box()
    mesh = meshio.Mesh(vertices, [("line", [[0, 1]]), ("quad", faces[:4]),
                                  ("triangle", [faces[4][:3], faces[4][:1] + faces[4][2:], faces[5][:3],
                                                faces[5][:1] + faces[5][2:]])],
                       cell_sets={"sides": [[], [0, 1], []], "ends": [[], [], [2, 3]]})
    scene = rad.from_meshio(mesh, materials={"sides": {"emission": 5}})
    assert scene.surface_names == ["sides", "other", "ends"]
    assert [scene.surface_names[k] for k in scene.face_surface] == (
        ["sides"] * 2 + ["other"] * 4 + ["ends"] * 2)
    assert rad.mesh(scene, patches=24).area.sum() == pytest.approx(6, rel=1e-12)


def test_meshio_physical_groups_become_surfaces():
    mesh = meshio.Mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [("triangle", [[0, 1, 2], [0, 2, 3]])],
                       cell_data={"gmsh:physical": [np.array([7, 9])]},
                       field_data={"inlet": np.array([7, 2])})
    assert rad.from_meshio(mesh).surface_names == ["inlet", "physical 9"]


def test_meshio_reads_the_formats_of_the_data_folder():
    scene = rad.from_meshio(meshio.read("data/city.stl"))
    mesh = rad.mesh(scene, faces_as_patches=True)
    direct = rad.mesh(rad.load("data/city.stl"), faces_as_patches=True)
    assert np.array_equal(np.sort(mesh.area), np.sort(direct.area))


def test_volumes_alone_give_their_skin():
    """Two unit cubes side by side: without the wall between them ten unit squares are left."""
    grid = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1, 2)], dtype=float)
    left = [0, 1, 4, 3, 6, 7, 10, 9]
    right = [1, 2, 5, 4, 7, 8, 11, 10]
    mesh = meshio.Mesh(grid, [("hexahedron", [left, right]), ("line", [[0, 1]])],
                       cell_sets={"oven": [[0], []], "tray": [[1], []]})
    with pytest.warns(UserWarning, match=r"volume cells alone \(2\): .* are the surfaces \(10\)$"):
        scene = rad.from_meshio(mesh)
    assert scene.surface_names == ["oven", "tray"]
    assert list(np.bincount(scene.face_surface)) == [5, 5]
    assert rad.mesh(scene, patches=40).area.sum() == pytest.approx(10, rel=1e-12)


def test_a_mesh_of_a_file_has_the_skin_that_the_file_has(tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], dtype=float)
    meshio.Mesh(corners, [("tetra", [[0, 1, 2, 3], [1, 2, 3, 4]])]).write(tmp_path / "two.vtu")
    with pytest.warns(UserWarning, match="volume"):
        read = rad.from_meshio(meshio.read(tmp_path / "two.vtu"))
        loaded = rad.load(str(tmp_path / "two.vtu"))
    faces = [np.sort(s.corners.reshape(-1, 3), axis=1).tolist() for s in (read, loaded)]
    assert len(faces[0]) == 6 and sorted(faces[0]) == sorted(faces[1])


def test_volumes_of_missing_points_are_refused():
    mesh = meshio.Mesh(np.eye(3), [("tetra", [[0, 1, 2, 7]])])
    with pytest.raises(rad.InputError, match="^meshio mesh: volume cell 0 has point 7; there are 3 points"):
        rad.from_meshio(mesh)


def test_a_mesh_of_lines_is_no_scene():
    mesh = meshio.Mesh(np.eye(4, 3), [("line", [[0, 1]])])
    with pytest.raises(rad.InputError, match="no faces but line; extract its surface"):
        rad.from_meshio(mesh)


def test_fields_go_back_to_meshio(cornell):
    mesh = cornell.mesh
    light = rad.solve(cornell)
    out = mesh.to_meshio(B=light.radiosity, area=mesh.area)
    triangles = out.points[out.cells[0].data]
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]),
                           axis=1) / 2
    B = out.cell_data["B"][0]
    assert np.allclose(areas @ B, mesh.area @ light.radiosity, rtol=1e-12)


class Trimesh(types.SimpleNamespace):
    """The members of a trimesh.Trimesh that from_trimesh() reads."""

    def copy(self):
        return Trimesh(vertices=self.vertices.copy(), faces=self.faces.copy())

    def apply_transform(self, transform):
        self.vertices = self.vertices @ transform[:3, :3].T + transform[:3, 3]


def triangles_of_box():
    vertices, faces = box()
    return Trimesh(vertices=vertices, faces=np.array([[f[0], f[k], f[k + 1]] for f in faces for k in (1, 2)]))


def test_a_trimesh_becomes_a_scene():
    scene = rad.from_trimesh(triangles_of_box())
    assert rad.mesh(scene, patches=24).area.sum() == pytest.approx(6, rel=1e-12)


class Graph(dict):
    nodes_geometry = ["left", "right"]


def test_trimesh_scenes_keep_their_places_and_names():
    moved = np.eye(4)
    moved[0, 3] = 3
    graph = Graph(left=(np.eye(4), "box"), right=(moved, "box"))
    scene = rad.from_trimesh(types.SimpleNamespace(geometry={"box": triangles_of_box()}, graph=graph),
                             materials={"right": {"emission": 1}})
    assert scene.surface_names == ["left", "right"]
    assert scene.vertices[:, 0].max() == 3.5
    with pytest.raises(rad.InputError, match="no faces"):
        rad.from_trimesh(types.SimpleNamespace(vertices=np.zeros((0, 3)), faces=np.zeros((0, 3))))


def test_a_mesh_becomes_pyvista_polygons(cornell):
    pyvista = pytest.importorskip("pyvista")
    poly = cornell.mesh.to_pyvista(area=cornell.mesh.area)
    assert isinstance(poly, pyvista.PolyData) and poly.n_cells == len(cornell.mesh.triangles)
