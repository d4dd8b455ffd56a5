"""Arrays in and out: lasting views, shapes, and messages for errors."""

import gc
import re
import warnings

import numpy as np
import pytest
import scipy.sparse

import radiosity as rad
from conftest import box


def test_views_outlive_their_owners():
    def views():
        scene = rad.load("data/furnace-cube.obj")
        mesh = rad.mesh(scene, patches=24)
        F = rad.form_factors(mesh)
        light = rad.solve(F)
        heat = rad.heat(F, 0.5, {"*": 300})
        owned = [scene.vertices, mesh.vertices, mesh.area, F.area, F.sky, light.radiosity,
                 heat.temperature, F.csr.data]
        return owned, [array.copy() for array in owned]

    owned, copies = views()
    gc.collect()
    junk = [np.random.default_rng(1).random(1000) for _ in range(100)]  # would fill what was freed
    assert len(junk) == 100
    for array, copy in zip(owned, copies):
        assert np.array_equal(array, copy)


def test_views_are_no_copies_and_read_only(cornell):
    mesh = cornell.mesh
    for get in (lambda: mesh.vertices, lambda: mesh.corners, lambda: mesh.area, lambda: mesh.surface,
                lambda: cornell.area, lambda: cornell.error, lambda: cornell.csr.data):
        array = get()
        assert np.shares_memory(array, get())
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_arrays_have_their_shapes_and_types(cornell):
    mesh = cornell.mesh
    n = len(mesh)
    assert mesh.vertices.shape[1] == 3 and mesh.vertices.dtype == np.float64
    assert mesh.corners.dtype == np.uint32 and mesh.corner_offset.shape == (n + 1,)
    assert mesh.corner_offset[-1] == len(mesh.corners)
    assert mesh.triangles.shape == (mesh.triangle_offset[-1], 3)
    assert cornell.csr.shape == (n, n) and cornell.csr.dtype == np.float32
    assert rad.form_factors(mesh, method="hemicube", resolution=16, precision="double").csr.dtype == np.float64


def test_form_factors_are_used_as_the_matrix(cornell):
    n = len(cornell)
    dense = cornell.csr.toarray()
    assert cornell.shape == (n, n)
    assert np.array_equal(np.asarray(cornell), dense) and np.asarray(cornell).dtype == np.float32
    assert np.array_equal(np.asarray(cornell, dtype=np.float64), dense.astype(np.float64))
    assert np.array_equal(cornell.T.toarray(), dense.T)
    i, j = (int(k[5]) for k in cornell.csr.nonzero())
    some = np.array([4, 0, n - 1])
    for key in [(i, j), (np.int64(i), -1), i, -2, slice(3, 9, 2), (slice(None), j), (i, slice(2, 7)), some,
                (slice(1, 4), some), (some, some[::-1]), np.ix_(some, some), np.arange(n) % 3 == 0]:
        picked, wanted = cornell[key], dense[key]
        assert np.shape(picked) == np.shape(wanted) and np.array_equal(picked, wanted), key
    with pytest.raises(IndexError):
        cornell[n]
    x = np.random.default_rng(7).random((n, 3))
    exact = dense.astype(np.float64)
    # Of a pair one value is stored, in single precision; the product makes the other by the areas, in
    # double, and csr lists it in single. All is positive, so no digits are lost in sums.
    for got, wanted in [(cornell @ x, exact @ x), (cornell @ x[:, 0], exact @ x[:, 0]),
                        (x[:, 0] @ cornell, x[:, 0] @ exact), (x.T @ cornell, x.T @ exact)]:
        assert got.shape == wanted.shape and got.dtype == np.float64
        np.testing.assert_allclose(got, wanted, rtol=np.finfo(np.float32).eps)
    product = cornell @ scipy.sparse.eye(n, format="csr")
    assert scipy.sparse.issparse(product) and np.array_equal(product.toarray(), dense)
    for bad in [x[1:], x[0], "text", np.full(n, np.nan)]:
        with pytest.raises(rad.InputError, match="^x: "):
            cornell @ bad
    # A matrix that lists no entries has products, too.
    cut = rad.form_factors(cornell.mesh, method="cut")
    rows = cut @ np.ones(n)
    np.testing.assert_allclose(rows, cut.fronts, rtol=1e-6)  # stored in single precision


def test_outlines_are_flat_polygons_of_the_given_area(cornell):
    mesh = cornell.mesh
    for i in range(0, len(mesh), 7):
        outline = mesh.vertices[mesh.corners[mesh.corner_offset[i]:mesh.corner_offset[i + 1]]]
        normal = sum(np.cross(outline[k - 1] - outline[0], outline[k] - outline[0])
                     for k in range(2, len(outline))) / 2
        assert np.allclose(normal, mesh.area[i] * mesh.normal[i], rtol=1e-9, atol=1e-12)


def test_a_million_faces_become_a_scene_and_a_mesh():
    side = 708  # 2 * 707^2 = 999,698 triangles
    u, v = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    vertices = np.column_stack([u.ravel(), v.ravel(), np.zeros(side * side)])
    corner = (u[:-1, :-1] * side + v[:-1, :-1]).ravel()
    faces = np.concatenate([np.stack([corner, corner + side, corner + side + 1], 1),
                            np.stack([corner, corner + side + 1, corner + 1], 1)])
    scene = rad.Scene(vertices, faces, groups=np.arange(len(faces)) % 3)
    assert len(scene.face_surface) == len(faces) == 999698
    assert scene.surface_names == ["0", "1", "2"]
    assert np.array_equal(scene.corners.reshape(-1, 3), faces)
    mesh = rad.mesh(scene, faces_as_patches=True)
    assert len(mesh) == len(faces)
    assert np.array_equal(mesh.source_face, np.arange(len(faces)))
    assert mesh.area.sum() == pytest.approx((side - 1) ** 2, rel=1e-12)


def test_scene_takes_strided_and_whole_number_arrays():
    vertices, faces = box()
    doubled = np.repeat(np.asarray(vertices * 2, dtype=np.int32), 2, axis=0)[::2]
    scene = rad.Scene(np.asfortranarray(doubled), np.asarray(faces, dtype=np.int64))
    assert np.array_equal(scene.vertices, np.round(vertices * 2))


def test_faces_may_have_several_lengths():
    scene = rad.Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3], [0, 1, 2]])
    assert scene.face_offset.tolist() == [0, 4, 7]


SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.mark.parametrize("call, message", [
    (lambda: rad.Scene(np.zeros((4, 2)), [[0, 1, 2]]), r"vertices: has shape \(4, 2\); give \(any, 3\)"),
    (lambda: rad.Scene([[0, 0, np.nan]] * 3, [[0, 1, 2]]), r"vertices: entry \(0, 2\) is nan"),
    (lambda: rad.Scene(np.zeros((3, 3), complex), [[0, 1, 2]]), "vertices: has dtype complex128"),
    (lambda: rad.Scene([["a", "b", "c"]], [[0, 1, 2]]), "vertices: has dtype <U1; give real numbers"),
    (lambda: rad.Scene(SQUARE, [[0, 1, 4]]), "faces: row 0 has index 4; there are 4 vertices"),
    (lambda: rad.Scene(SQUARE, [[0, 1, -1]]), "faces: row 0 has index -1"),
    (lambda: rad.Scene(SQUARE, [[0.0, 1.0, 2.0]]), "faces: has dtype float64; give whole numbers"),
    (lambda: rad.Scene(SQUARE, [[0, 1]]), "faces: have 2 corners"),
    (lambda: rad.Scene(SQUARE, [[0, 1, 2]], groups=["a", "b"]), r"groups: has shape \(2,\).*\(1,\)"),
    (lambda: rad.Scene(SQUARE, [[0, 1, 2]], groups=["a"], materials={"b": {}}),
     "no group is called 'b'; there are: a"),
    (lambda: rad.Scene(SQUARE, [[0, 1, 2]], materials={"surface": {"colour": 1}}),
     "no property 'colour'; there are: reflectance, emission, two_sided"),
    (lambda: rad.Scene(SQUARE, [[0, 1, 2]], materials={"surface": {"reflectance": 1.5}}),
     "reflectance of 'surface': is 1.5; give 0 to 1"),
    (lambda: rad.load("data/none.obj"), "data/none.obj"),
    (lambda: rad.load("data/cornell-box.obj", unit="mile"), "unit"),
    (lambda: rad.mesh("data/cornell-box.obj"), "scene: is of type str; give a Scene"),
    (lambda: rad.mesh(rad.load("data/cornell-box.obj"), patches=0), "patches: 0 is out of range; 1 to"),
    (lambda: rad.mesh(rad.load("data/cornell-box.obj"), weld=1.0), "weld"),
    (lambda: rad.read("README.md"), "README.md: is no matrix of form factors"),
])
def test_wrong_arrays_are_refused_in_one_line(call, message):
    with pytest.raises(rad.InputError) as raised:
        call()
    assert re.search(message, str(raised.value)), raised.value
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("call, message", [
    (lambda F: rad.form_factors(F.mesh, 2.0), "tolerance"),
    (lambda F: rad.form_factors(F.mesh, method="guess"), "'guess' is not one of auto, exact"),
    (lambda F: rad.form_factors(F), "mesh: is of type FormFactors"),
    (lambda F: F.between("lamp", "none"), "none: no surface, material or object.*lamp/light"),
    (lambda F: F.table(groups=["a=nothing*"]), "groups='a=nothing.*matches no surface"),
    (lambda F: rad.solve(F, emission=np.ones(3)), r"emission: has shape \(3,\); give .*N = "),
    (lambda F: rad.solve(F, emission=np.ones(len(F.mesh))), "reflectance: the scene's has 3 bands"),
    (lambda F: rad.solve(F, 1.5), "reflectance"),
    (lambda F: rad.solve(F, emission=np.full((len(F.mesh), 3), np.inf)), r"emission: entry \(0, 0\) is inf"),
    (lambda F: rad.solve(F, emission=np.full((len(F.mesh), 3), -1.0)), "emission"),
    (lambda F: rad.solve(F, solver="magic"), "'magic' is not one of auto, jacobi"),
    (lambda F: rad.heat(F), "no conditions are given"),
    (lambda F: rad.heat(F, 0.8), "no condition for floor/white"),
    (lambda F: rad.heat(F, {"flor": 0.8}, 300), "called flor; there are"),
    (lambda F: rad.heat(F, 0.8, np.ones(3)), "temperature: is an array"),
    (lambda F: rad.render(F.mesh, np.ones(3)), r"light: has shape \(3,\)"),
    (lambda F: rad.render(F.mesh, np.ones(len(F.mesh)), width=0), "width"),
    (lambda F: rad.render(F.mesh, np.ones(len(F.mesh)), camera="sideways"), "camera"),
    (lambda F: rad.render(F.mesh, np.ones(len(F.mesh)), camera={"eye": (0, 0, 0)}), "no target"),
    (lambda F: rad.view_factors_from(F.mesh, [[0, 0]], [0, 0, 1]), r"points: has shape \(1, 2\)"),
    (lambda F: rad.view_factors_from(F.mesh, [[0, 0, 0]], [0, 0, 0]), "normal 0 has no direction"),
    (lambda F: rad.from_csr(np.ones((2, 3)), [1, 1]), "matrix: has shape"),
    (lambda F: rad.from_csr([[0, -1], [1, 0]], [1, 1]), "row 0, column 1 is -1.0"),
    (lambda F: rad.from_csr([[0, 1], [1, 0]], [1, 1, 1]), r"area: has shape \(3,\); give \(2,\)"),
    (lambda F: rad.from_csr([[0, 1], [1, 0]], [1, 1]).save("x.h5"), "matrix without a mesh"),
])
def test_wrong_arguments_of_later_steps_are_refused(cornell, call, message):
    with pytest.raises(rad.InputError) as raised:
        call(cornell)
    assert re.search(message, str(raised.value)), raised.value
    assert "--" not in str(raised.value), "options of the command line are no names here"


def test_a_memory_limit_is_a_run_error(cornell):
    with pytest.raises(rad.RunError, match="more than the limit of 1 B"):
        rad.form_factors(cornell.mesh, memory_limit=1)
    assert issubclass(rad.RunError, RuntimeError) and issubclass(rad.InputError, ValueError)


def test_own_matrices_keep_their_values():
    rng = np.random.default_rng(3)
    dense = rng.random((30, 30)) * (rng.random((30, 30)) < 0.4) / 30
    for dtype in (np.float32, np.float64):
        A = scipy.sparse.csr_matrix(dense.astype(dtype))
        with pytest.warns(UserWarning, match="A_i F_ij and A_j F_ji differ"):
            F = rad.from_csr(A, np.ones(30))
        assert F.csr.dtype == dtype and (F.csr != A).nnz == 0
        assert np.allclose(F.sky, 1 - A.sum(axis=1).A1)
    twice = scipy.sparse.coo_matrix(([0.25, 0.25, 0.0], ([0, 0, 1], [1, 1, 0])), shape=(2, 2))
    with pytest.warns(UserWarning, match="A_i F_ij and A_j F_ji differ"):
        assert rad.from_csr(twice, [1, 1]).csr.toarray().tolist() == [[0, 0.5], [0, 0]]


def test_only_rows_above_one_are_warned_of():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert rad.from_csr([[0, 1], [0.5, 0]], [1, 2]).report["notes"] == []
    with pytest.warns(UserWarning, match=r"row 1 sums to 1.5 \(2 rows are above 1\): form factors sum to 1 at most"):
        rad.from_csr([[0, 1.5], [1.5, 0]], [1, 1])
