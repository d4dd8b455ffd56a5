"""A wrong argument is named in one line; unused ones are named, too."""

import copy
import os
import pickle
import re
import sys
import warnings

import numpy as np
import pytest
import scipy.sparse

import radiosity as rad
from conftest import ROOT

CORNELL = "data/cornell-box.obj"
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


@pytest.fixture(scope="module")
def plates():
    """Two plates that face each other, 8 patches."""
    return rad.form_factors(rad.mesh(rad.load(ROOT / "data/facing-plates.obj"), patches=8))


def refused(call, message):
    with pytest.raises(rad.InputError) as raised:
        call()
    assert re.search(message, str(raised.value)), raised.value
    assert "\n" not in str(raised.value) and "PYBIND" not in str(raised.value)
    assert "--" not in str(raised.value), "options of the command line are no names here"


def ones(F):
    return np.ones(len(F.mesh))


@pytest.mark.parametrize("call, message", [
    (lambda F: rad.form_factors(F.mesh, tolerance="a"), "^tolerance: is 'a' of type str; give a number"),
    (lambda F: rad.form_factors(F.mesh, resolution=32.5), "^resolution: is 32.5 of type float; give a whole"),
    (lambda F: rad.form_factors(F.mesh, seed=1.5), "^seed: is 1.5 of type float; give a whole number"),
    (lambda F: rad.form_factors(F.mesh, seed=-1), "^seed: is -1 of type int; give a whole number, 0 to"),
    (lambda F: rad.form_factors(F.mesh, seed=np.float32(1.5)), "^seed: is 1.5 of type float32; give a whole"),
    (lambda F: rad.form_factors(F.mesh, memory_limit="1G"), "^memory_limit: is '1G' of type str"),
    (lambda F: rad.form_factors(F.mesh, memory_limit=-1), "^memory_limit: is -1 of type int"),
    (lambda F: rad.form_factors(F.mesh, scratch_folder=3), "^scratch_folder: is of type int"),
    (lambda F: rad.form_factors(F.mesh, eye="hawk"), "^eye: 'hawk' is not one of cpu, gl, auto"),
    (lambda F: rad.solve(F, max_iterations=1.5), "^max_iterations: is 1.5 of type float"),
    (lambda F: rad.solve(F, tolerance="x"), "^tolerance: is 'x' of type str; give a number"),
    (lambda F: rad.heat(F, 0.8, 300, sky_temperature="x"), "^sky_temperature: is 'x' of type str"),
    (lambda F: rad.heat(F, 0.8, 300, band_edges="x"), "^band_edges: has dtype <U1"),
    (lambda F: rad.heat(F, 0.8, 300, table=3), "^table: is of type int; give the path of a file"),
    (lambda F: rad.render(F.mesh, ones(F), width="8"), "^width: is '8' of type str"),
    (lambda F: rad.render(F.mesh, ones(F), samples="x"), "^samples: is 'x' of type str"),
    (lambda F: rad.render(F.mesh, ones(F), crease="x"), "^crease: is 'x' of type str"),
    (lambda F: rad.render(F.mesh, ones(F), camera={"eye": (0, 0), "target": (0, 0, 1)}),
     r"^camera eye: is \(0, 0\) of type tuple; give three numbers"),
    (lambda F: rad.render(F.mesh, ones(F), camera={"eye": "0,0,0", "target": (0, 0, 1)}),
     "^camera eye: is '0,0,0' of type str; give three numbers"),
    (lambda F: rad.render(F.mesh, ones(F), camera=3), "^camera: is 3 of type int; give a name, a text or a dict"),
    (lambda F: rad.render(F.mesh, ones(F), camera={"eye": (0, 0, 0), "target": (0, 0, 1), "fov": 40}),
     r"^camera: has no property 'fov'; there are: name, .*vertical_fov \(radians\)"),
    (lambda F: rad.displayed(np.zeros((2, 2, 4)), exposure="x"), "^exposure: has dtype <U1"),
    (lambda F: rad.displayed(np.zeros((2, 2, 4)), exposure=2000), "^exposure: is 2000; give stops"),
    (lambda F: rad.Scene(SQUARE, None), "^faces: is of type NoneType; give"),
    (lambda F: rad.Scene(SQUARE, []), "^faces: are none; give at least one"),
    (lambda F: rad.Scene(SQUARE, [0, 1, 2]), "^faces: face 0 is 0; give its corners"),
    (lambda F: rad.Scene(SQUARE, [[0, 1, 2], 3]), "^faces: face 1 is 3; give its corners"),
    (lambda F: rad.Scene(SQUARE, [[0, 1, 2]], materials={"surface": {1: 2, "a": 3}}),
     "^materials: 'surface' has no property 1"),
    (lambda F: rad.Scene(SQUARE, [[0, 1, 2]], materials={"surface": {"two_sided": "no"}}),
     "^two_sided of 'surface': is 'no'; give True or False"),
    (lambda F: rad.Scene(np.ma.masked_equal(SQUARE, 1), [[0, 1, 2]]), "^vertices: has masked entries"),
    (lambda F: rad.solve(F, 0.5, np.ma.masked_less(ones(F), 2)), "^emission: has masked entries"),
    (lambda F: rad.heat(F, 0.8, power={"a": 3}, isothermal={"a": "no"}),
     "^isothermal of 'a': is 'no'; give True or False"),
    (lambda F: rad.heat(F, {"a": {300: 1, "b": 1}}, 300), "^emissivity of 'a', a temperature: has dtype <U1"),
    (lambda F: rad.from_csr([[0, 1], [1, 0]], [1, 1], names=3), "^names: is of type int; give 2 texts"),
    (lambda F: rad.from_csr([[0, 1], [1, 0]], [1, -1]), "^area: row 1 is -1.0; give 0 or more"),
    (lambda F: rad.load(""), "^path: is ''; give the path of a file"),
    (lambda F: rad.load("a\0b"), "^path: is 'a.x00b'; give the path of a file"),
    (lambda F: rad.load(CORNELL, default_reflectance=2), "^default_reflectance: 2 is out of range; 0 to 1"),
    (lambda F: rad.mesh(F.mesh.scene, max_edge=-1), "^max_edge: -1 m is out of range"),
    (lambda F: rad.load(CORNELL, kd_is_srgb="yes"), "^kd_is_srgb: is 'yes' of type str; give True or False"),
    (lambda F: rad.load(CORNELL, default_reflectance="x"), "^default_reflectance: is 'x' of type str"),
    (lambda F: rad.load(CORNELL, set=[3]), "^set: is of type int; give texts"),
    (lambda F: rad.load(3), "^path: is of type int; give the path of a file"),
    (lambda F: rad.read(3), "^path: is of type int"),
    (lambda F: rad.mesh(F.mesh.scene, patches="many"), "^patches: is 'many' of type str; give a whole number"),
    (lambda F: rad.mesh(F.mesh.scene, patches=float("nan")), "^patches: is nan of type float"),
    (lambda F: rad.mesh(F.mesh.scene, patches=100.7), "^patches: is 100.7 of type float"),
    (lambda F: rad.mesh(F.mesh.scene, patches=10**30), "^patches: is 10{30} of type int; give a whole number, 0 to"),
    (lambda F: rad.mesh(F.mesh.scene, patches=np.ones((9, 9))), r"^patches: is array\(\[\[1.*\.\.\. of type ndarray"),
    (lambda F: rad.mesh(F.mesh.scene, max_edge="x"), "^max_edge: is 'x' of type str"),
    (lambda F: rad.set_threads("a"), "^threads: is 'a' of type str"),
    (lambda F: rad.set_threads(-1), "^threads: is -1 of type int; give a whole number, 0 to"),
    (lambda F: rad.gather(F.mesh, passes=1.5), "^passes: is 1.5 of type float"),
    (lambda F: rad.gather(F.mesh, at="moon"), "^at: 'moon' is not one of vertices, patches"),
])
def test_wrong_values_are_named(plates, call, message):
    refused(lambda: call(plates), message)


def test_a_room_that_faces_outward_is_said_and_turned(tmp_path):
    square = {"floor": "1 4 3 2", "ceiling": "5 6 7 8", "wall": "1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8"}
    path = tmp_path / "room.obj"
    path.write_text("".join(f"v {x} {y} {z}\n" for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
                    + "".join(f"o {name}\nf {faces}\n" for name, faces in square.items()))
    with pytest.warns(UserWarning, match="^no material"):
        scene = rad.load(path)
        turned = rad.load(path, flip="all")
        without = rad.load(path, without=["ceil*"])
    with pytest.warns(UserWarning, match="the closed shell floor, ceiling, wall faces "
                                         "outward, .* turn it over, flip='all'$"):
        assert rad.form_factors(rad.mesh(scene, patches=6)).csr.nnz == 0
    assert any(note["text"].startswith("all (") and "turned over" in note["text"] for note in turned.notes)
    factors = rad.form_factors(rad.mesh(turned, patches=6), tolerance=1e-6)
    assert factors.csr[0, 1] == pytest.approx(.199825, abs=2e-6)  # opposite faces of a cube
    assert without.surface_names == ["floor", "wall"]
    with pytest.raises(rad.InputError, match="^without='flor': no surface, material or object is called flor"):
        rad.load(path, without="flor")


def test_whole_numbers_may_be_of_any_type(plates):
    mesh = rad.mesh(plates.mesh.scene, patches=np.float32(8))
    assert len(mesh) == len(rad.mesh(mesh.scene, patches=np.int16(8))) == len(rad.mesh(mesh.scene, patches=8))
    image = rad.render(mesh, np.ones(len(mesh)), width=8.0, height=np.uint8(6), samples=np.array(2))
    assert image.shape == (6, 8, 4)
    assert len(rad.form_factors(mesh, np.float32(1e-3), seed=2**64 - 1, method="rays")) == 8


@pytest.mark.parametrize("call, message", [
    (lambda F: rad.solve(F.mesh), r"^F: is of type Mesh; give form factors: rad.form_factors\(mesh\)"),
    (lambda F: rad.heat(F.mesh, 0.8, 300), "^F: is of type Mesh; give form factors"),
    (lambda F: rad.render(F.mesh.scene, ones(F)), "^mesh: is of type Scene; give a Mesh"),
    (lambda F: rad.render(F, ones(F)), "^mesh: is of type FormFactors; give a Mesh"),
    (lambda F: rad.render(F.mesh, F), r"^light: is of type FormFactors; give a Solution, rad.solve\(F\)"),
    (lambda F: rad.render(F.mesh, None), "^light: is of type NoneType; give real numbers"),
    (lambda F: rad.view_factors_from(F.mesh.scene, [[0, 0, 0]], [0, 0, 1]), "^mesh: is of type Scene"),
    (lambda F: rad.gather(F), "^mesh: is of type FormFactors; give a Mesh"),
    (lambda F: F.save("x.h5", solution=3), "^solution: is of type int; give a Solution"),
    (lambda F: F.save("x.h5", heat=rad.solve(F)), "^heat: is of type Solution; give a Heat"),
    (lambda F: F.save(3), "^path: is of type int"),
    (lambda F: F.table(groups=3), "^groups: is of type int; give texts"),
    (lambda F: F.mesh.per_patch([1.0, 2.0]), "^by_name: is of type list; give a dict by the name"),
    (lambda F: rad.Scene(SQUARE, [[0, 1, 2]], materials=["white"]), "^materials: is of type list; give a dict"),
    (lambda F: rad.Scene(SQUARE, [[0, 1, 2]], materials={"surface": 0.5}),
     "^material of 'surface': is of type float; give a dict of properties"),
    (lambda F: rad.from_meshio(3), "^mesh: is of type int; give a meshio.Mesh"),
    (lambda F: rad.from_trimesh(3), "^mesh: is of type int; give a trimesh.Trimesh or Scene"),
])
def test_wrong_objects_are_named(plates, call, message):
    refused(lambda: call(plates), message)


@pytest.mark.parametrize("name", ["scene.obj", "picture.png", "f.mtx", "f.hdf5", "plain"])
def test_results_overwrite_no_other_file(plates, tmp_path, name):
    path = tmp_path / name
    path.write_text("of someone else")
    refused(lambda: plates.save(path), f"{name}: is no name of a results file; end it in .h5")
    assert path.read_text() == "of someone else"


@pytest.mark.parametrize("call, message", [
    (lambda: rad.from_csr([[0, 1], [1, 0]], [1, 1], sky=[-3, 7]), "^sky: row 0 is -3.0; give 0 or more"),
    (lambda: rad.from_csr([[0, 1], [1, 0]], [1, 1], backs=[0, -1]), "^backs: row 1 is -1.0; give 0 or more"),
    (lambda: rad.from_csr([[0, 1], [1, 0]], [1, 1], sky=[0, np.inf]), "^sky: entry 1 is inf"),
    (lambda: rad.from_csr([[0, 1], [1, 0]], [1, 1], names="ab"), "^names: are 1; give 2"),
    (lambda: rad.solve(rad.from_csr([[0]], [1]), np.nan, [1]), "^reflectance: is nan; give a finite number"),
    (lambda: rad.load(CORNELL, set="lamp.glow=3"), "^set='lamp.glow=3': "),
    (lambda: rad.load(CORNELL, two_sided="none"), "^two_sided='none'"),
])
def test_values_out_of_range_are_named(call, message):
    refused(call, message)


def test_one_text_is_a_list_of_one():
    scene = rad.load(CORNELL, set="white.reflectance=.9", two_sided="all")
    assert all(material["two_sided"] for material in scene.materials)
    white = next(material for material in scene.materials if material["name"] == "white")
    assert white["reflectance"] == [0.9] * 3
    F = rad.form_factors(rad.mesh(scene, patches=60))
    assert "boxes" in F.table(groups="boxes=*block/*").names


@pytest.mark.parametrize("options, unused", [
    ({"tolerance": 1e-6, "method": "hemicube", "resolution": 16}, "hemicube: tolerance"),
    ({"closure": "off", "method": "hemicube", "resolution": 16}, "hemicube: closure"),
    ({"resolution": 64, "near_exact": True, "method": "rays", "tolerance": 0.1}, "rays: resolution, near_exact"),
    ({"seed": 2, "eye": "gl", "method": "exact"}, "exact: seed, eye"),
])
def test_options_of_other_methods_are_warned_of(plates, options, unused):
    with pytest.warns(UserWarning, match=f"^not used by the method {unused}$") as told:
        rad.form_factors(plates.mesh, **options)
    assert told[0].filename == __file__


def test_options_that_are_used_are_not_warned_of(plates):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rad.form_factors(plates.mesh, method="hemicube", resolution=16, seed=2, near_exact=True, symmetrize=True)
        rad.form_factors(plates.mesh, 0.1, method="rays", seed=2, closure="off")
        rad.form_factors(plates.mesh, 1e-4, method="exact", closure="off")


def test_missing_convergence_is_warned_of(cube):
    with pytest.warns(UserWarning, match="no convergence: 1 Jacobi sweeps") as told:
        light = rad.solve(cube, 0.9, np.ones(24), solver="jacobi", max_iterations=1)
    assert not light.summary["usable"] and told[0].filename == __file__
    with pytest.warns(UserWarning, match="not usable") as told:
        heat = rad.heat(cube, {"*": {300: 0.1, 3000: 0.9}}, flux=1e4, convection=5, ambient=300,
                        max_iterations=1)
    assert not heat.summary["usable"] and told[0].filename == __file__


def test_notes_name_keywords(tmp_path):
    (tmp_path / "plain.obj").write_text("mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.warns(UserWarning, match="give materials by set or a JSON materials file"):
        scene = rad.load(tmp_path / "plain.obj")
    assert not any("--" in note["text"] for note in scene.notes)


def test_emissivities_of_patches_are_no_emissivities_of_surfaces(cube):
    refused(lambda: rad.heat(cube, np.full(24, 0.5), 300),
            r"^emissivity: has 24 values; give one number, 1 \(one a band\), or a dict by surface name")


def room_with_a_heater():
    v = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    f = [[2, 3, 1, 0], [5, 7, 6, 4], [1, 5, 4, 0], [6, 7, 3, 2], [4, 6, 2, 0], [3, 7, 5, 1]]
    scene = rad.Scene(v, f, groups=["heater", "tray", "wall", "wall", "wall", "wall"])
    return rad.form_factors(rad.mesh(scene, patches=24))


def test_incomplete_conditions_name_the_cure():
    F = room_with_a_heater()
    temperature = {"heater": 1200, "tray": None}
    refused(lambda: rad.heat(F, emissivity={"wall": 0.8}, temperature={**temperature, "*": 300}),
            r"^(heater: has no emissivity|no emissivity for heater, tray).* by the name \*")
    refused(lambda: rad.heat(F, emissivity={"wall": 0.8, "*": 0.9}, temperature=temperature),
            r"^no condition for wall: give a temperature, flux .* by the name \*")
    refused(lambda: rad.heat(F, emissivity={"wall": 0.8}, temperature=temperature), r"heater|wall.* by the name \*")
    heat = rad.heat(F, {"wall": 0.8, "*": 0.9}, {"heater": 1200, "tray": None, "*": 300})
    tray = next(row for row in heat.table() if row["name"] == "tray")
    assert 300 < tray["temperature"] < 1200


def test_a_package_that_is_missing_is_named(plates, monkeypatch):
    for name in ("meshio", "pyvista"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match="^meshio is not installed; install Debian's python3-meshio, or run `pip"):
        plates.mesh.to_meshio()
    with pytest.raises(ImportError, match="^pyvista is not installed; run `pip install pyvista`"):
        plates.mesh.to_pyvista()


def test_broken_sparse_matrices_are_refused():
    """scipy trusts the arrays of a matrix and reads past their ends."""
    def broken(change):
        matrix = scipy.sparse.csr_matrix([[0, 1.0], [1.0, 0]])
        change(matrix)
        return matrix

    def start(matrix):
        matrix.indptr[1] = 9

    def column(matrix):
        matrix.indices = matrix.indices.astype(np.int64)
        matrix.indices[0] += 2**32

    def negative(matrix):
        matrix.indices[0] = -1

    for change in (start, column, negative):
        refused(lambda: rad.from_csr(broken(change), [1, 1]), "^matrix: is no valid csr matrix: ")
    places = scipy.sparse.coo_matrix([[0, 1.0], [1.0, 0]])
    places.row[0] = 10**7
    refused(lambda: rad.from_csr(places, [1, 1]), "^matrix: is no valid coo matrix: a row is outside 0 to 1")


def test_names_of_other_bytes_than_utf8_are_kept(tmp_path):
    text = (ROOT / "data/furnace-cube.obj").read_bytes().replace(b"cube_floor", b"Fu\xdfboden")
    (tmp_path / "cube.obj").write_bytes(text.replace(b"furnace-cube.mtl", b"w\xe4nde.mtl"))
    (tmp_path / os.fsdecode(b"w\xe4nde.mtl")).write_bytes((ROOT / "data/furnace-cube.mtl").read_bytes())
    scene = rad.load(tmp_path / "cube.obj")
    name = "Fu\udcdfboden/wall"
    assert name in scene.surface_names
    mesh = rad.mesh(scene, patches=24)
    F = rad.form_factors(mesh)
    assert 0 < F.between(name, "cube_north") < 1
    assert "Fu\\xdfboden" in str(F.table())
    with_name = rad.load(tmp_path / "cube.obj", set="Fu\udcdfboden.emission=7")
    assert rad.mesh(with_name, patches=24).emission.max() == 7
    refused(lambda: F.between("door", name), r"door: no surface.* Fu.xdfboden/wall")
    refused(lambda: rad.load(tmp_path / "cube.obj", set="door.emission=7"), r"Fu.xdfboden")
    F.save(tmp_path / os.fsdecode(b"w\xfcrfel.h5"))
    again = rad.read(os.fsencode(tmp_path) + b"/w\xfcrfel.h5")
    assert again.mesh.surface_names == mesh.surface_names


def test_objects_are_not_pickled_and_copies_are_themselves(plates, tmp_path):
    light = rad.solve(plates, 0.5, ones(plates))
    for made in (plates, plates.mesh, plates.mesh.scene, light):
        assert copy.copy(made) is made and copy.deepcopy(made) is made
        with pytest.raises(TypeError, match="cannot be pickled; keep it in a results file"):
            pickle.dumps(made)
    plates.save(tmp_path / "plates.h5", solution=copy.copy(light))
    assert rad.read(tmp_path / "plates.h5").solution is not None


def test_cells_of_meshio_that_are_not_read_are_named():
    meshio = pytest.importorskip("meshio")
    points = np.random.default_rng(1).random((13, 3))
    mesh = meshio.Mesh(points, [("triangle", [[0, 1, 2]]), ("triangle10", [list(range(3, 13))])])
    with pytest.warns(UserWarning, match="left out triangle10"):
        rad.from_meshio(mesh)
    mesh = meshio.Mesh(points, [("triangle", [[0, 1, 2]])], cell_sets={"a": [[-1]]})
    refused(lambda: rad.from_meshio(mesh), "^meshio mesh: cell set 'a' has cell -1 of block 0")


def test_a_light_is_named():
    refused(lambda: rad.load(ROOT / CORNELL, sky="bright"), "^sky: 'bright' is not one finite number")
    refused(lambda: rad.load(ROOT / CORNELL, lights="lamp,3"), "^light: no light is called 'lamp'")
    refused(lambda: rad.load(ROOT / CORNELL, lights=[rad.Light("point", at=1)]), "at '1' is not X,Y,Z")
    refused(lambda: rad.load(ROOT / CORNELL, lights=[3]), "^lights: is of type int")
