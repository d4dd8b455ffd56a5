"""Python and the command line compute the same bits."""

import json

import h5py
import numpy as np
import pytest
import scipy.sparse

import radiosity as rad

SCENE = "data/cornell-box.obj"


def stored(path, name):
    with h5py.File(path) as file:
        return file[name][...]


@pytest.mark.parametrize("method, options", [("exact", {}), ("rays", {"tolerance": 0.05}),
                                             ("hemicube", {"resolution": 32}),
                                             ("hemicube", {"resolution": 32, "eye": "auto"})])
def test_form_factors_and_light_are_the_same(run_program, method, options):
    words = [word for name, value in options.items() for word in (f"--{name}", value)]
    folder = run_program("solve", SCENE, "--patches", 80, "--method", method, *words, "-o", "s.h5")
    mesh = rad.mesh(rad.load(SCENE), patches=80)
    F = rad.form_factors(mesh, method=method, **options)
    light = rad.solve(F)
    path = folder / "s.h5"
    for name in ("data", "indices", "indptr"):
        assert np.array_equal(getattr(F.csr, name), stored(path, f"form_factors/{name}")), name
    assert np.array_equal(F.area, stored(path, "form_factors/area"))
    assert np.array_equal(light.radiosity, stored(path, "solution/radiosity"))
    assert np.array_equal(light.irradiance, stored(path, "solution/irradiance"))
    assert np.array_equal(mesh.vertices, stored(path, "mesh/vertices"))


def test_rows_that_are_cut_solve_and_are_no_pairs(run_program):
    folder = run_program("solve", SCENE, "--patches", 80, "--method", "cut", "-o", "s.h5")
    F = rad.form_factors(rad.mesh(rad.load(SCENE), patches=80), method="cut")
    assert F.method == "cut"
    light = rad.solve(F)
    assert np.array_equal(light.radiosity, stored(folder / "s.h5", "solution/radiosity"))
    with pytest.raises(rad.InputError, match="not stored pair by pair"):
        F.csr


def test_heat_by_name_is_the_same(run_program):
    scene = "data/cornell-box-closed.obj"
    words = ["*.emissivity=0.8", "lamp.temperature=900", "short_block.emissivity=300:0.1 1000:0.25",
             "*.flux=0", "floor.convection=5", "floor.ambient=290"]
    folder = run_program("heat", scene, "--patches", 60, "--method", "exact", "-o", "h.h5",
                         *(part for word in words for part in ("--condition", word)))
    F = rad.form_factors(rad.mesh(rad.load(scene), patches=60), method="exact")
    heat = rad.heat(F, {"*": 0.8, "short_block": {300: 0.1, 1000: 0.25}}, {"lamp": 900, "*": None},
                    convection={"floor": 5}, ambient={"floor": 290})
    assert np.array_equal(heat.temperature, stored(folder / "h.h5", "heat/temperature"))
    assert np.array_equal(heat.net_flux, stored(folder / "h.h5", "heat/net_flux"))


@pytest.mark.parametrize("elements", [True, False])
def test_pictures_are_the_same(run_program, elements):
    coarse = ["--element-tolerance", 0.3] if elements else []
    # Without a tolerance, form factors for elements alone are coarser on the command line.
    folder = run_program("render", SCENE, "--patches", 80, "--method", "exact", "--tolerance", 1e-3,
                         "--width", 16, "--elements", "on" if elements else "off", *coarse,
                         "-o", "p.exr")
    mesh = rad.mesh(rad.load(SCENE), patches=80)
    image = rad.render(mesh, rad.solve(rad.form_factors(mesh, method="exact")), width=16,
                       elements=elements, element_tolerance=0.3)
    image[..., :3] *= image[..., 3:]  # as the format has it
    assert np.array_equal(image, exr(folder / "p.exr"))


def test_radiant_temperatures_are_the_same(run_program):
    conditions = ["--condition", "*.emissivity=0.8", "--condition", "lamp.temperature=900",
                  "--condition", "*.flux=0", "--sky-temperature", 280]
    folder = run_program("heat", SCENE, "--patches", 80, "--method", "exact", *conditions,
                         "--plane", ".1,.45,.1:.4,.45,.1:.4,.45,.4:.1", "--point-table", "t.csv")
    table = np.genfromtxt(folder / "t.csv", delimiter=",", names=True)
    F = rad.form_factors(rad.mesh(rad.load(SCENE), patches=80), method="exact")
    heat = rad.heat(F, 0.8, {"lamp": 900, "*": None}, sky_temperature=280)
    points = np.stack([table[name] for name in ("x_m", "y_m", "z_m")], axis=-1)
    felt = heat.radiant_temperature(points)
    # Above the blocks; the table has 6 digits or more.
    assert np.allclose(felt.standing, table["standing_K"], rtol=2e-6) and len(points) > 3
    assert np.allclose(felt.seated, table["seated_K"], rtol=2e-6)
    assert (felt.plane.max(axis=1) > felt.standing).all()
    colder = heat.radiant_temperature(points, sky_temperature=0)
    assert (colder.standing < felt.standing).all()
    F.save(folder / "h.h5", heat=heat)
    with pytest.raises(rad.InputError, match="sky_temperature: is not known"):
        rad.read(folder / "h.h5").heat.radiant_temperature(points)


def test_a_picture_of_all_defaults_is_the_same(run_program):
    folder = run_program("solve", SCENE, "-o", "s.h5")
    run_program("render", "s.h5", "-o", "p.exr")
    mesh = rad.mesh(rad.load(SCENE))
    image = rad.render(mesh, rad.solve(rad.form_factors(mesh)))
    image[..., :3] *= image[..., 3:]
    assert np.array_equal(image, exr(folder / "p.exr"))


def test_tables_are_the_same(run_program):
    folder = run_program("factors", SCENE, "--patches", 80, "--between", "surfaces", "-o", "t.json")
    said = json.loads((folder / "t.json").read_text())
    table = rad.form_factors(rad.mesh(rad.load(SCENE), patches=80)).table()
    assert table.names == said["names"]
    for name, values in {"area": "area_m2", "factors": "form_factors", "sky": "sky", "backs": "backs",
                         "error": "entry_error"}.items():
        assert np.array_equal(getattr(table, name), np.array(said[values])), name


@pytest.mark.parametrize("at", ["patches", "vertices"])
def test_gathered_light_is_the_same(run_program, at):
    folder = run_program("gather", SCENE, "--patches", 80, "--resolution", 32, "--at", at, "--passes", 4,
                         "-o", "g.h5")
    mesh = rad.mesh(rad.load(SCENE), patches=80)
    light = rad.gather(mesh, at=at, resolution=32, passes=4)
    path = folder / "g.h5"
    assert np.array_equal(light.eye_radiosity, stored(path, "gather/radiosity"))
    assert np.array_equal(light.eye_irradiance, stored(path, "gather/irradiance"))
    assert np.array_equal(light.eye_position, stored(path, "gather/position"))
    assert len(light.passes) == 4 and light.summary["status"] == "pass_limit"
    assert light.radiosity.shape == (len(mesh), 3)
    if at == "patches":
        assert np.array_equal(light.radiosity, light.eye_radiosity)


def exr(path):
    oiio = pytest.importorskip("OpenImageIO")
    return oiio.ImageInput.open(str(path)).read_image(format=oiio.FLOAT)


def test_the_command_line_reuses_what_python_saved(run_program, tmp_path):
    folder = run_program("info", SCENE)
    F = rad.form_factors(rad.mesh(rad.load(SCENE), patches=80), method="exact")
    path = folder / "s.h5"
    F.save(path, solution=rad.solve(F))
    before = stored(path, "form_factors/data")
    run_program("solve", "s.h5", "--report", "run.json")
    said = (folder / "run.json").read_text()
    assert '"recomputed"' not in said and '"computed"' not in said
    assert np.array_equal(before, stored(path, "form_factors/data"))


def test_python_reads_what_the_command_line_wrote(run_program):
    folder = run_program("solve", SCENE, "--patches", 80, "--method", "exact", "-o", "s.h5")
    run_program("factors", "s.h5", "-o", "f.mtx")
    results = rad.read(folder / "s.h5")
    assert np.array_equal(results.solution.radiosity, stored(folder / "s.h5", "solution/radiosity"))
    assert results.mesh.surface_names == results.scene.surface_names
    again = rad.solve(results.form_factors)
    assert np.array_equal(again.radiosity, results.solution.radiosity)
    of_text = rad.read(folder / "f.mtx").form_factors
    # The file has the values of a symmetric matrix in 17 digits, scipy's rows are rounded to float32.
    assert np.allclose(of_text.csr.toarray(), results.form_factors.csr.toarray(), rtol=6e-8, atol=0)
    assert of_text.mesh is None and "lamp/light" in of_text.table().names


def test_threads_change_no_bit(cornell):
    one = rad.form_factors(cornell.mesh, method="exact")
    rad.set_threads(1)
    try:
        two = rad.form_factors(cornell.mesh, method="exact")
    finally:
        rad.set_threads(0)
    assert np.array_equal(one.csr.data, two.csr.data)
    assert scipy.sparse.issparse(one.csr)
