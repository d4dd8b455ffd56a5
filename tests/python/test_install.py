"""The installed package: by pip, without network and isolation."""

import os
import shutil
import subprocess
import sys

from conftest import ROOT

BUILD = os.environ["RADIOSITY_BUILD_DIR"]
PYTHON = f"python{sys.version_info.major}.{sys.version_info.minor}"

SCRIPT = """
import numpy as np
import radiosity as rad
F = rad.form_factors(rad.mesh(rad.load("data/furnace-cube.obj"), patches=24))
print(rad.__file__)
print(abs(F.csr.sum(axis=1) - 1).max())
image = rad.render(F.mesh, np.ones(24), width=8)
"""


def run(*command, **environment):
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT,
                          env={**{k: v for k, v in os.environ.items() if k != "PYTHONPATH"}, **environment})
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def works(package):
    """A package folder on the path is complete, and finds the program that is installed with it."""
    said = run(sys.executable, "-c", SCRIPT, PYTHONPATH=str(package)).split()
    assert said[0].startswith(str(package))
    assert float(said[1]) < 1e-4
    assert "0.1" in run(sys.executable, "-m", "radiosity", "--version", PYTHONPATH=str(package))


def test_pip_installs_a_complete_package(tmp_path):
    run(sys.executable, "-m", "pip", "install", ".", "--no-build-isolation", "--no-index",
        "--prefix", str(tmp_path), f"--config-settings=build-dir={BUILD}", "--quiet")
    package = next(tmp_path.glob(f"**/{PYTHON}/*-packages"))
    works(package)
    # Pictures take a library that is opened only when it is needed.
    picture = "data/cornell-box.png"
    program = package.parents[2] / "bin/radiosity"
    assert (package.parents[2] / "share/man/man1/radiosity-render.1").exists()
    assert "difference" in run(program, "compare", picture, picture)


def test_cmake_installs_a_complete_package(tmp_path):
    run("cmake", "--install", BUILD, "--prefix", str(tmp_path))
    works(tmp_path / f"lib/{PYTHON}/site-packages")


def test_what_the_build_lacks_is_said_in_a_line(tmp_path):
    # A cmake that does not see what has its package files in /usr/share.
    blind = tmp_path / "bin/cmake"
    blind.parent.mkdir()
    blind.write_text(f'#!/bin/sh\nexec {shutil.which("cmake")} "$@" -DCMAKE_IGNORE_PREFIX_PATH=/usr\n')
    blind.chmod(0o755)
    call = f"import wheel_of_cmake as w; w.build_wheel({str(tmp_path)!r}, {{'build-dir': {str(tmp_path / 'b')!r}}})"
    done = subprocess.run([sys.executable, "-c", call], capture_output=True, text=True, cwd=ROOT / "src/python",
                          env={**os.environ, "PATH": f"{blind.parent}:{os.environ['PATH']}"})
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr.startswith("radiosity: cmake does not find Eigen3; ") and done.stderr.count("\n") == 1
    assert "Eigen3" in (tmp_path / "b/configure.log").read_text()
    empty = subprocess.run([sys.executable, "-c", call], capture_output=True, text=True, cwd=ROOT / "src/python",
                           env={**os.environ, "PATH": ""})
    assert empty.stderr == ("radiosity: there is no cmake; on Debian, tools/setup installs all that the build "
                            "takes\n")
