"""Small scenes that the tests share; run by `python_test` of ctest, from the repository's root."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

import radiosity as rad

ROOT = Path(os.environ["RADIOSITY_SOURCE_DIR"])
PROGRAM = os.environ["RADIOSITY"]


@pytest.fixture(autouse=True)
def in_the_root(monkeypatch):
    monkeypatch.chdir(ROOT)


@pytest.fixture
def run_program(tmp_path):
    """Runs the command line in a folder of the test's own, where data/ is."""
    (tmp_path / "data").symlink_to(ROOT / "data")

    def run(*arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=tmp_path, capture_output=True,
                              text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return tmp_path

    return run


@pytest.fixture(scope="session")
def cornell():
    """The Cornell box: mesh and exact form factors."""
    mesh = rad.mesh(rad.load(ROOT / "data/cornell-box.obj"), patches=150)
    return rad.form_factors(mesh, method="exact")


@pytest.fixture(scope="session")
def cube():
    """A closed cube, seen from inside."""
    return rad.form_factors(rad.mesh(rad.load(ROOT / "data/furnace-cube.obj"), patches=24),
                            tolerance=1e-6)


def box(size=1.0):
    """Vertices and outward faces of a cube in the middle."""
    v = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    f = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return (v - 0.5) * size, f
