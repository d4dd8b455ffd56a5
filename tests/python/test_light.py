"""Light, heat, tables and sensors against closed forms and against each other."""

import warnings

import numpy as np
import pytest

import radiosity as rad
from conftest import ROOT, box


def dense_solution(F, rho, E):
    """B = E + rho F B by numpy, column by column."""
    A = F.csr.toarray().astype(float)
    return np.linalg.solve(np.eye(len(F)) - rho[:, None] * A, E)


def test_emission_may_have_every_shape(cornell):
    n = len(cornell.mesh)
    rng = np.random.default_rng(1)
    E = rng.random((n, 2, 3))
    rho = rng.random((n, 2)) * 0.8
    all_lamps = rad.solve(cornell, rho, E, tolerance=1e-10)
    assert all_lamps.radiosity.shape == (n, 2, 3)
    for k in range(3):
        one_lamp = rad.solve(cornell, rho, E[:, :, k], tolerance=1e-10)
        for b in range(2):
            expected = dense_solution(cornell, rho[:, b], E[:, b, k])
            # F_ji follows from a stored F_ij in double precision; scipy's is rounded to float32.
            assert np.allclose(all_lamps.radiosity[:, b, k], expected, rtol=1e-5)
            assert np.allclose(one_lamp.radiosity[:, b], expected, rtol=1e-5)
            alone = rad.solve(cornell, rho[:, b], E[:, b, k], tolerance=1e-10)
            assert alone.radiosity.shape == (n,)
            assert np.allclose(alone.radiosity, expected, rtol=1e-5)


def test_a_furnace_has_its_closed_form(cube):
    light = rad.solve(cube, reflectance=0.75, emission=np.ones(24), tolerance=1e-12)
    # B = E / (1 - rho) for any F with rows that sum to 1: exact form factors to 1e-6.
    assert np.allclose(light.radiosity, 4, rtol=4e-6)
    assert light.summary["usable"] and light.summary["energy"]["to_sky"][0] == pytest.approx(0, abs=1e-9)


def test_a_singular_room_is_a_run_error(cube):
    with pytest.raises(rad.RunError, match="singular"):
        rad.solve(cube, reflectance=1.0, emission=np.ones(24))


def test_an_own_matrix_solves_as_in_numpy():
    rng = np.random.default_rng(2)
    A = rng.random((40, 40)) / 40
    F = rad.from_csr(A, rng.random(40) + 0.5)
    rho = rng.random(40) * 0.9
    E = rng.random((40, 2))
    light = rad.solve(F, rho, E, tolerance=1e-13)
    assert np.allclose(light.radiosity, dense_solution(F, rho, E), rtol=1e-11)
    with pytest.raises(rad.InputError, match="have no scene"):
        rad.solve(F)


def test_a_table_sums_the_matrix(cornell):
    table = cornell.table()
    A = cornell.csr.toarray().astype(float)
    surface = cornell.mesh.surface
    for a, name in enumerate(table.names):
        of_a = surface == cornell.mesh.surface_names.index(name)
        for b, other in enumerate(table.names):
            of_b = surface == cornell.mesh.surface_names.index(other)
            expected = cornell.area[of_a] @ A[np.ix_(of_a, of_b)].sum(axis=1) / cornell.area[of_a].sum()
            assert table.factors[a, b] == pytest.approx(expected, rel=1e-6, abs=1e-9)
    assert np.allclose(table.factors.sum(axis=1) + table.sky + table.backs, 1, atol=1e-6)
    # All white surfaces by their material's name, and one by its object's.
    white = [k for k, name in enumerate(table.names) if name.endswith("/white")]
    assert cornell.between("lamp", "white") == pytest.approx(
        table.factors[table.names.index("lamp/light"), white].sum(), rel=1e-12)
    assert "| lamp/light |" in str(table)


def test_a_lamp_without_a_surface_lights_a_room():
    lamp = rad.Light("point", intensity="100cd", at=(0.5, 0.5, 0.5), name="my lamp")
    scene = rad.load(ROOT / "data/furnace-cube.obj", set="all.emission=0", lights=[lamp, "spot,1W,at=.5,.5,.5"])
    F = rad.form_factors(rad.mesh(scene, patches=24), tolerance=1e-6)
    light = rad.solve(F, tolerance=1e-10)
    # The cube is 1 m wide and closed: all of both lamps falls on it.
    assert light.summary["energy"]["from_sky"] == pytest.approx([4 * np.pi * 100 / 683 + 1] * 3, rel=1e-2)
    assert repr(lamp) == "<Light point,intensity=100cd,at=0.5,0.5,0.5,name=my%20lamp>"
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    floor = rad.Scene(square, [[0, 1, 2, 3]], sun="500,toward=0,0,1,diameter=0")
    under_sun = rad.solve(rad.form_factors(rad.mesh(floor, patches=4)))
    assert np.allclose(under_sun.irradiance, 500)


def test_a_lamp_of_a_file_lights_a_room(tmp_path):
    file = tmp_path / "a, lamp.ies"
    file.write_text("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 180\n0\n100 100\n")
    lamp = rad.Light("ies", file=file, at=(0.5, 0.5, 0.5), name="my lamp")
    scene = rad.load(ROOT / "data/furnace-cube.obj", set="all.emission=0", lights=lamp)
    file.unlink()
    light = rad.solve(rad.form_factors(rad.mesh(scene, patches=24), tolerance=1e-6), tolerance=1e-10)
    # .25% a patch, each by itself.
    assert light.summary["energy"]["from_sky"] == pytest.approx([4 * np.pi * 100 / 683] * 3, rel=1e-3)
    with pytest.raises(rad.InputError, match="no such file"):
        rad.load(ROOT / "data/furnace-cube.obj", lights=lamp)
    with pytest.raises(rad.InputError, match="file: is of type int; give the path of a file"):
        rad.Light("ies", file=7)


def test_a_sky_may_be_an_array_and_no_light_an_empty_text():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for sky in (np.array([1.0, 2.0, 3.0]), np.array(2.0), np.float32(2), [1, 2, 3]):
            scene = rad.Scene(square, [[0, 1, 2, 3]], sky=sky)
            assert scene.sky == pytest.approx(np.broadcast_to(sky, 3))
    for given in ({"sky": ""}, {"sun": ""}):
        with pytest.raises(rad.InputError, match="is an empty text; give its strength, or leave it out"):
            rad.Scene(square, [[0, 1, 2, 3]], **given)
    with pytest.raises(rad.InputError, match="lights: has an empty text"):
        rad.Scene(square, [[0, 1, 2, 3]], lights=[""])
    with pytest.raises(rad.InputError, match="intensity: is an empty text"):
        rad.Light("point", intensity="")


def test_a_table_of_an_own_matrix_goes_by_row_names():
    F = rad.from_csr([[0, 0.2, 0.3], [0.2, 0, 0.1], [0.15, 0.05, 0]], [1, 1, 2], names=["a", "a", "b"])
    assert F.between("a", "b") == pytest.approx(0.2)  # (1 * 0.3 + 1 * 0.1) / 2
    assert F.table().area.tolist() == [2, 2]


def test_heat_between_plates_has_its_closed_form():
    F = rad.from_csr([[0, 1], [1, 0]], [1, 1])
    sigma = 5.67037441918443e-8
    got = rad.heat(F, emissivity=[0.8, 0.5], temperature=[1000, np.nan], flux=[np.nan, -1000])
    expected = (1000**4 - 1000 / sigma * (1 / 0.8 + 1 / 0.5 - 1)) ** 0.25
    assert got.temperature[1] == pytest.approx(expected, rel=1e-9)  # the solver's tolerance
    assert got.summary["balance"]["radiated"] == pytest.approx(0, abs=1e-5)


def test_rows_of_a_matrix_take_every_condition_by_name():
    F = rad.from_csr([[0, 1], [1, 0]], [1, 1], names=["hot", "cold"])
    sigma, h, ambient = 5.67037441918443e-8, 5.0, 300.0
    got = rad.heat(F, {"hot": 0.8, "cold": {100: 0.5, 2000: 0.5}}, {"hot": 1000, "cold": None},
                   power={"cold": -1000}, convection={"cold": h}, ambient={"cold": ambient})
    T = got.temperature[1]
    # What arrives by radiation is taken out or given to the air.
    arriving = sigma * (1000**4 - T**4) / (1 / 0.8 + 1 / 0.5 - 1)
    assert arriving == pytest.approx(1000 + h * (T - ambient), rel=1e-8)  # the solver's tolerance
    cold = got.table()[1]
    assert (cold["name"], cold["convected"]) == ("cold", pytest.approx(h * (T - ambient)))
    with pytest.raises(rad.InputError, match="power: does not go with arrays"):
        rad.heat(F, [0.8, 0.5], 300, power={"cold": 1})


def test_heat_of_a_name_without_temperature_is_adiabatic():
    F = rad.form_factors(rad.mesh(rad.load("data/cornell-box-closed.obj"), patches=60))
    heat = rad.heat(F, 0.8, {"lamp": 1200, "floor": 300, "*": None})
    rows = {row["name"]: row for row in heat.table()}
    assert rows["lamp/light"]["temperature"] == pytest.approx(1200)
    assert rows["left_wall/red"]["radiated"] == pytest.approx(0, abs=1e-5)
    assert 300 < rows["left_wall/red"]["temperature"] < 1200


def test_points_get_what_the_patches_that_they_see_send(cornell):
    light = rad.solve(cornell)
    mesh = cornell.mesh
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    points = low + (high - low) * [[.5, .8, .5], [.2, .6, .8], [.8, .6, .3]]
    found = light.illuminance(points, [0, 1, 0])
    seen = rad.view_factors_from(mesh, points, [0, 1, 0])
    assert found.total.shape == found.direct.shape == (3, 3) and found.cube_lux.shape == (3, 6)
    assert np.array_equal(found.in_body, [False] * 3) and (found.error <= 0.01).all()
    # Exact, 2e-6 of the scene's diagonal off its place, the lamp a tenth of it away or more.
    assert np.allclose(found.direct, seen @ light.emission, rtol=1e-4)
    # Rays, to 1%, on sources that are finer than 150 patches.
    assert np.allclose(found.total, seen @ light.radiosity, rtol=0.02)
    assert np.allclose(found.lux, 683 * found.total @ [.2126, .7152, .0722])
    assert np.allclose(found.direct_lux + found.indirect_lux, found.lux)
    assert np.allclose(found.lux, found.cube_lux[:, 2], rtol=0.02)  # +y
    assert np.array_equal(light.illuminance(points).total, found.total)  # up


def test_points_have_the_bands_and_lamps_of_the_solution(cube):
    middle = [cube.mesh.vertices.mean(axis=0)]
    lamps = rad.solve(cube, 0.5, np.ones((24, 2, 3)) * [1, 2, 3]).illuminance(middle)
    # B = E / (1 - rho); sources in single precision.
    assert np.allclose(lamps.total, [[[2, 4, 6]] * 2], rtol=1e-5) and lamps.lux is None
    grey = rad.solve(cube, 0.5, np.ones(24)).illuminance(middle, tolerance=0.05)
    assert grey.total.shape == (1,) and np.allclose(grey.cylindrical_lux, 2 * 683, rtol=1e-5)
    with pytest.raises(rad.InputError, match="tolerance: 2"):
        rad.solve(cube, 0.5, np.ones(24)).illuminance(middle, tolerance=2)
    with pytest.raises(rad.InputError, match="without a mesh"):
        rad.solve(rad.from_csr([[0, 1], [1, 0]], [1, 1]), 0.5, [1, 1]).illuminance(middle)
    with pytest.raises(rad.InputError, match="normal 0 has no direction"):
        rad.solve(cube, 0.5, np.ones(24)).illuminance(middle, [0, 0, 0])


def rectangle_above(a, b, c):
    """Howell B-3: from a small surface to a parallel a x b rectangle, a corner of which is c above it."""
    x, y = a / c, b / c
    return (x / np.sqrt(1 + x * x) * np.arctan(y / np.sqrt(1 + x * x)) +
            y / np.sqrt(1 + y * y) * np.arctan(x / np.sqrt(1 + y * y))) / (2 * np.pi)


def plate(z, a=2.0, b=1.0, name="plate"):
    return [[0, 0, z], [0, b, z], [a, b, z], [a, 0, z]], name  # looks down


def test_a_sensor_below_a_plate_has_its_closed_form():
    vertices, name = plate(0.7)
    mesh = rad.mesh(rad.Scene(vertices, [[0, 1, 2, 3]], [name]), patches=9)
    row = rad.view_factors_from(mesh, [[0, 0, 0]], [0, 0, 1])
    assert row.shape == (1, len(mesh))
    assert row.sum() == pytest.approx(rectangle_above(2, 1, 0.7), rel=1e-12)
    # From above, its back is black; from a side, none of it is above the horizon.
    assert rad.view_factors_from(mesh, [[0.3, 0.3, 2]], [0, 0, -1]).sum() == 0
    assert rad.view_factors_from(mesh, [[-1, 0, 0]], [-1, 0, 0]).sum() == 0


def test_a_sensor_does_not_see_covered_parts():
    high, low = plate(1.0)[0], plate(0.5, 1.0, 1.0)[0]
    scene = rad.Scene(high + low, [[0, 1, 2, 3], [4, 5, 6, 7]], ["high", "low"])
    mesh = rad.mesh(scene, patches=40)
    sees = mesh.per_patch({"high": 1.0})
    row = rad.view_factors_from(mesh, [[0, 0, 0]], [0, 0, 3])[0]
    # The low plate's shadow on the high one is twice as large, and covers it.
    assert row @ sees == pytest.approx(0, abs=1e-15)
    aside = rad.view_factors_from(mesh, [[2, 0, 0]], [0, 0, 1])[0]
    # From below the corner (2, 0) the low plate, 1 to 2 to the left, 0.5 above, hides 2 and more.
    assert aside @ sees == pytest.approx(rectangle_above(2, 1, 1.0), rel=1e-12)


def test_sensors_in_a_closed_box_see_all_of_it():
    vertices, faces = box()
    mesh = rad.mesh(rad.Scene(vertices, [face[::-1] for face in faces]), patches=54)
    rng = np.random.default_rng(4)
    points = rng.random((20, 3)) - 0.5
    rows = rad.view_factors_from(mesh, points, rng.standard_normal((20, 3)))
    assert np.allclose(rows.sum(axis=1), 1, rtol=1e-10)  # Lambert's sums of a few patches' edges
    # On a wall, upright and askew: upright the wall itself is on the horizon.
    on_wall = rad.view_factors_from(mesh, [[0.1, 0.2, -0.5]] * 2, [[0, 0, 1], [1, 0, 1]])
    assert np.allclose(on_wall.sum(axis=1), 1, rtol=1e-5)  # it is 2e-7 of the diagonal off the wall
    wall = np.isclose(mesh.normal[:, 2], 1)
    assert on_wall[0, wall].sum() == 0
    assert on_wall[1, wall].sum() == pytest.approx((1 - np.cos(np.pi / 4)) / 2, rel=1e-4)


def test_sensors_outside_see_the_hull_and_through_none_of_it():
    vertices, faces = box()
    mesh = rad.mesh(rad.Scene(vertices, faces), patches=54)
    outside = rad.view_factors_from(mesh, [[0, 0, 5]], [0, 0, -1])[0]
    corner = rectangle_above(0.5, 0.5, 4.5)
    assert outside.sum() == pytest.approx(4 * corner, rel=1e-10)
    assert set(np.flatnonzero(outside)) == set(np.flatnonzero(mesh.normal[:, 2] > 0.5))
    inside = rad.view_factors_from(mesh, [[0, 0, 0]], [0, 0, 1])
    assert inside.sum() == 0  # backs alone


def test_irradiance_at_sensors_is_near_that_of_the_patches(cornell):
    mesh = cornell.mesh
    light = rad.solve(cornell)
    floor = np.flatnonzero(mesh.per_patch({"floor": 1.0}))[::5]
    rows = rad.view_factors_from(mesh, mesh.centroid[floor], mesh.normal[floor])
    at_points = rows @ light.radiosity
    # Point against mean over the patch: they differ by the curvature of light over a patch.
    assert np.allclose(at_points, light.irradiance[floor], rtol=0.15)


def test_arrays_are_drawn_as_radiance(cornell):
    values = cornell.mesh.per_patch({"lamp": np.pi}, 0.0)
    image = rad.render(cornell.mesh, values, width=64, smooth=False, samples=1)
    assert image.shape == (64, 64, 4) and image.dtype == np.float32
    hit = image[image[..., 3] == 1]
    assert set(np.unique(hit[:, :3])) == {0, 1}  # radiance is B / pi
    shown = rad.displayed(image)
    assert shown.min() >= 0 and shown.max() <= 1


def test_light_is_shown_in_lux(cube):
    light = rad.solve(cube, reflectance=0.5, emission=np.ones(24), tolerance=1e-9)
    # B = H = E / (1 - rho) = 2 W/m^2 everywhere, for rows that sum to 1 within 1e-6; 683 lm/W.
    for show, expected in [("illuminance", 683 * 2), ("luminance", 683 * 2 / np.pi), ("radiance", 2 / np.pi)]:
        shown = rad.render(cube.mesh, light, width=20, height=10, show=show, elements=False)
        assert shown.values.shape == (10, 20) and shown.values.dtype == np.float64
        assert np.allclose(shown.values, expected, rtol=1e-5), show
        assert shown.image.shape == (10, 20, 4)  # too small for a legend
    shown = rad.render(cube.mesh, light, width=128, show="luminance", range=(0, 1000))
    assert shown.image.shape[0] > 128 and 0 <= shown.image.min() and shown.image.max() <= 1
    # Other ends, other colours.
    assert (rad.render(cube.mesh, light, width=128, show="luminance", range=(0, 500)).image != shown.image).any()


def test_a_picture_has_layers(cornell):
    light = rad.solve(cornell)
    image, layers = rad.render(cornell.mesh, light, width=24, samples=2, layers=True)
    assert set(layers) == {"depth", "normal", "patch", "surface", "albedo", "direct", "indirect"}
    whole = image[..., :3] * image[..., 3:]
    assert np.allclose(layers["direct"] + layers["indirect"], whole, atol=1e-5 * whole.max())  # float32
    hit = layers["patch"][..., 0] >= 0
    assert np.allclose(np.linalg.norm(layers["normal"][hit], axis=-1), 1, atol=1e-6)
    assert np.isinf(layers["depth"][~hit]).all()
    of = layers["patch"][..., 0][hit].astype(int)
    assert (cornell.mesh.surface[of] == layers["surface"][..., 0][hit]).all()


def test_what_cannot_be_shown_is_refused(cornell):
    light = rad.solve(cornell)
    ones = np.ones(len(cornell.mesh))
    for call, match in [(dict(show="glare"), "show: is 'glare'; give one of: radiance, luminance, illuminance"),
                        (dict(show="luminance", range=(5, 5)), "range: is 5.0, 5.0"),
                        (dict(range=(0, 5)), "range: is of false colours"),
                        (dict(show="radiance", layers=True), "layers: are of the lit picture"),
                        (dict(layers=True, elements=False), "direct")]:
        with pytest.raises(rad.InputError, match=match):
            rad.render(cornell.mesh, light, width=8, **call)
    with pytest.raises(rad.InputError, match="illuminance needs a Solution"):
        rad.render(cornell.mesh, ones, show="illuminance")


def test_heat_and_gathered_light_are_drawn(cornell):
    mesh = cornell.mesh
    oven = rad.heat(rad.form_factors(mesh, 0.1), 0.8, {"lamp": 1200, "*": 300})
    seen = rad.gather(mesh, passes=1, resolution=32)
    for light in (oven, seen):
        same = rad.render(mesh, light.radiosity, width=8)
        assert same.max() > 0
        assert (rad.render(mesh, light, width=8) == same).all()


def test_skies_light_and_the_daylight_factor_is_told():
    square = [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]]
    overcast = rad.Light("cie-sky", diffuse="10000lx", type=16)
    black = {"groups": ["floor"], "materials": {"floor": {"reflectance": 0}}}
    for scene in (rad.Scene(square, [[0, 1, 2, 3]], lights=[overcast], **black),
                  rad.Scene(square, [[0, 1, 2, 3]], cie_sky="10000lx,type=16", **black)):
        F = rad.form_factors(rad.mesh(scene, patches=4))
        light = rad.solve(F)
        # By rays, to .5% of each patch; three times that.
        assert light.irradiance == pytest.approx(np.full_like(light.irradiance, 10000 / 683), rel=1.5e-2)
        # Up, and upright: (3 pi + 8) / (14 pi) of that under Moon and Spencer's sky. Rays to .2%.
        found = light.illuminance([[0, 0.5, 0]] * 2, [[0, 1, 0], [1, 0, 0]], tolerance=2e-3)
        assert found.daylight_factor == pytest.approx([100, 100 * (3 * np.pi + 8) / (14 * np.pi)], rel=6e-3)
    with pytest.raises(rad.InputError, match="where the sun stands"):
        rad.Scene(square, [[0, 1, 2, 3]], lights=[rad.Light("cie-sky", diffuse=1, type=12)])
    lamps = rad.Scene(square, [[0, 1, 2, 3]], lights=[overcast, rad.Light("point", intensity=1, at=(0, 1, 0))])
    light = rad.solve(rad.form_factors(rad.mesh(lamps, patches=4)))
    assert light.illuminance([[0, 0.5, 0]]).daylight_factor is None
