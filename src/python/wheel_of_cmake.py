"""What `pip install .` asks for a wheel: cmake builds and installs, the result is packed.

The wheel holds the package, and beside it (in pip's "data" scheme, PREFIX/bin and PREFIX/lib) the
program, the libraries that it is linked to, manuals and scenes, where `cmake --install` would put them.
`pip install . --config-settings=build-dir=build/release` takes a build folder that is there already.
"""

import base64
import hashlib
import importlib.util
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"

METADATA = """Metadata-Version: 2.1
Name: radiosity
Version: {version}
Summary: Radiosity by the matrix method: form factors, solution, picture
License: GPL-3.0-or-later
Requires-Python: =={python}.*
Requires-Dist: {numpy}
Requires-Dist: scipy
"""
WHEEL = """Wheel-Version: 1.0
Generator: wheel_of_cmake
Root-Is-Purelib: false
Tag: {tag}
"""


def version():
    header = (ROOT / "include/radiosity/version.h").read_text()
    return re.search(r'RADIOSITY_VERSION "([^"]+)"', header).group(1)


# How cmake says what it does not find.
MISSING = [
    r'package configuration file provided by "([^"]+)"',
    r"Could NOT find ([^ \n]+)",
    r"Could not find [A-Z0-9_]+ using the following (?:files|names): ([^\n]+)",
    r"No CMAKE_(C\w*)_COMPILER could be\s+found",
]


def pybind11_of_pip():
    """The folder of its package files for cmake; None where it is too old, and for Debian's 2.10: what
    it compiles takes numpy 1 alone."""
    if importlib.util.find_spec("pybind11") is None:
        return None
    import pybind11
    return pybind11.get_cmake_dir() if pybind11.version_info[:2] >= (2, 12) else None


def configured(folder):
    """Configures as people run the program. What is missing is said in a line; cmake takes a page."""
    options = ["RADIOSITY_TESTS=OFF", "CMAKE_INSTALL_LIBDIR=lib", f"Python3_EXECUTABLE={sys.executable}"]
    if pybind11_of_pip():
        options.append(f"pybind11_DIR={pybind11_of_pip()}")
    done = subprocess.run(["cmake", "--preset", "release", "-B", folder, *(f"-D{option}" for option in options)],
                          cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode == 0:
        return
    (folder / "CMakeCache.txt").unlink(missing_ok=True)  # it would be taken for a good one
    folder.mkdir(parents=True, exist_ok=True)
    log = folder / "configure.log"
    log.write_text(done.stdout)
    found = (re.search(pattern, done.stdout) for pattern in MISSING)
    missing = next((match.group(1) for match in found if match), "something that it takes")
    sys.exit(f"radiosity: cmake does not find {missing}; on Debian, tools/setup installs all that the build takes "
             f"(cmake's own words are in {log})")


def built(folder):
    """Builds into `folder`, as it is configured or as people run the program."""
    for program in ("cmake", "ninja"):
        if shutil.which(program) is None:
            sys.exit(f"radiosity: there is no {program}; on Debian, tools/setup installs all that the build takes")
    if not (folder / "CMakeCache.txt").exists():
        configured(folder)
        print("radiosity: building takes five to ten minutes of two cores", flush=True)
    if "build radiosity_python:" not in (folder / "build.ninja").read_text():
        sys.exit("radiosity: the build has no Python package; it needs the headers of Python and pybind11 "
                 "(Debian: tools/setup)")
    subprocess.run(["cmake", "--build", folder, "--target", "radiosity", "radiosity_cli", "radiosity_python"],
                   check=True)


def parts(prefix, data):
    """Files of an installation with their places in the wheel. Libraries are there under the name that
    others are linked to, since a wheel has no links."""
    package = next(prefix.glob(f"lib*/**/python{PYTHON}/site-packages"))
    for path in sorted(package.rglob("*")):
        if path.is_file():
            yield path, str(path.relative_to(package))
    helper = package.parents[1] / "radiosity-assimp"
    for path in [prefix / "bin/radiosity", helper, *sorted((prefix / "share").rglob("*"))]:
        if path.is_file():
            yield path, f"{data}/{path.relative_to(prefix)}"
    for path in sorted((package.parents[1] / "radiosity").glob("*.so*")):  # libraries of others
        yield path, f"{data}/{path.relative_to(prefix)}"
    for path in sorted(package.parents[1].glob("*.so*")):
        if not path.is_symlink() and not re.search(r"\.so\.\d+\.", path.name):
            yield path, f"{data}/{path.relative_to(prefix)}"
        elif re.search(r"\.so\.\d+$", path.name):
            yield path.resolve(), f"{data}/{path.relative_to(prefix)}"


class Wheel:
    """`date`: of its files, (year, ..., second); without one the first that an archive can have."""

    def __init__(self, path, info, date=(1980, 1, 1, 0, 0, 0)):
        self.file = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.info = info
        self.date = date
        self.record = []

    def add(self, name, data, mode=0o644):
        entry = zipfile.ZipInfo(name, self.date)
        entry.external_attr = (0o100000 | mode) << 16
        self.file.writestr(entry, data, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.record.append(f"{name},sha256={digest},{len(data)}\n")

    def close(self):
        self.record.append(f"{self.info}/RECORD,,\n")
        entry = zipfile.ZipInfo(f"{self.info}/RECORD", self.date)
        entry.external_attr = 0o100644 << 16
        self.file.writestr(entry, "".join(self.record), zipfile.ZIP_DEFLATED)
        self.file.close()


def get_requires_for_build_wheel(config_settings=None):
    """Programs that are not there (PEP 517)."""
    return [package for package, program in [("cmake >= 3.25", "cmake"), ("ninja", "ninja")]
            if shutil.which(program) is None]


def described(system=None):
    """The wheel's tag, and the files that describe it. `system`: this one, if none."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{system or re.sub(r'[-.]', '_', sysconfig.get_platform())}"
    numpy = "numpy" if pybind11_of_pip() else "numpy < 2"
    return tag, {"METADATA": METADATA.format(version=version(), python=PYTHON, numpy=numpy),
                 "WHEEL": WHEEL.format(tag=tag)}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """So pip looks for numpy and scipy before minutes of building, not after them (PEP 517)."""
    folder = Path(metadata_directory) / f"radiosity-{version()}.dist-info"
    folder.mkdir()
    for name, text in described()[1].items():
        (folder / name).write_text(text)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The hook that pip calls (PEP 517)."""
    folder = Path((config_settings or {}).get("build-dir", ROOT / "build/pip")).resolve()
    built(folder)
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(["cmake", "--install", folder, "--prefix", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        return packed(Path(prefix), Path(wheel_directory), *described())


def packed(prefix, directory, tag, descriptions, **options):
    """Makes the wheel of an installation; returns its name."""
    stem = f"radiosity-{version()}"
    wheel = Wheel(directory / f"{stem}-{tag}.whl", f"{stem}.dist-info", **options)
    for path, name in parts(prefix, f"{stem}.data/data"):
        wheel.add(name, path.read_bytes(), path.stat().st_mode & 0o777)
    for name, text in descriptions.items():
        wheel.add(f"{stem}.dist-info/{name}", text.encode())
    wheel.close()
    return f"{stem}-{tag}.whl"


def complete_wheel(prefix, directory, epoch):
    """Makes the wheel of an installation that has all libraries but glibc's in it (tools/package); returns its
    path. The glibc of this machine is the oldest that it runs with, which the tag says (PEP 600)."""
    glibc = platform.libc_ver()[1].replace(".", "_")
    date = time.gmtime(int(epoch))[:6]
    name = packed(Path(prefix), Path(directory), *described(f"manylinux_{glibc}_{platform.machine()}"), date=date)
    return str(Path(directory) / name)
