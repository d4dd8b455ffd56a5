"""What `pip install .` asks for a wheel: cmake builds and installs, the result is packed.

The wheel holds the package, and beside it (in pip's "data" scheme, PREFIX/bin and PREFIX/lib) the
program and the libraries that it is linked to, where `cmake --install` would put them. `pip install .
--config-settings=build-dir=build/release` takes a build folder that is there already.
"""

import base64
import hashlib
import re
import subprocess
import sys
import sysconfig
import tempfile
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
Requires-Dist: numpy
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


def built(folder):
    """Builds into `folder`, as it is configured or as people run the program."""
    if not (folder / "CMakeCache.txt").exists():
        options = ["CMAKE_BUILD_TYPE=Release", "RADIOSITY_TESTS=OFF", "CMAKE_INSTALL_LIBDIR=lib",
                   f"Python3_EXECUTABLE={sys.executable}"]
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja",
                        *(f"-D{option}" for option in options)], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "radiosity", "radiosity_cli",
                    "radiosity_images", "radiosity_draco", "radiosity_assimp", "radiosity_python"], check=True)


def parts(prefix, data):
    """Files of an installation with their places in the wheel. Libraries are there under the name that
    others are linked to, since a wheel has no links."""
    package = next(prefix.glob(f"lib*/**/python{PYTHON}/site-packages"), None)
    if package is None:
        sys.exit("radiosity: the build has no Python package; it needs the headers of Python, numpy "
                 "and pybind11 (Debian: tools/setup)")
    for path in sorted(package.rglob("*")):
        if path.is_file():
            yield path, str(path.relative_to(package))
    yield prefix / "bin/radiosity", f"{data}/bin/radiosity"
    helper = package.parents[1] / "radiosity-assimp"
    yield helper, f"{data}/{helper.relative_to(prefix)}"
    for path in sorted(package.parents[1].glob("*.so*")):
        if not path.is_symlink() and not re.search(r"\.so\.\d+\.", path.name):
            yield path, f"{data}/{path.relative_to(prefix)}"
        elif re.search(r"\.so\.\d+$", path.name):
            yield path.resolve(), f"{data}/{path.relative_to(prefix)}"


class Wheel:
    def __init__(self, path, info):
        self.file = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED)
        self.info = info
        self.record = []

    def add(self, name, data, mode=0o644):
        entry = zipfile.ZipInfo(name)
        entry.external_attr = (0o100000 | mode) << 16
        self.file.writestr(entry, data, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        self.record.append(f"{name},sha256={digest},{len(data)}\n")

    def close(self):
        self.record.append(f"{self.info}/RECORD,,\n")
        self.file.writestr(f"{self.info}/RECORD", "".join(self.record))
        self.file.close()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """The hook that pip calls (PEP 517)."""
    folder = Path((config_settings or {}).get("build-dir", ROOT / "build/pip"))
    built(folder)
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    tag = f"{python}-{python}-{platform}"
    stem = f"radiosity-{version()}"
    wheel = Wheel(Path(wheel_directory) / f"{stem}-{tag}.whl", f"{stem}.dist-info")
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(["cmake", "--install", folder, "--prefix", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        for path, name in parts(Path(prefix), f"{stem}.data/data"):
            wheel.add(name, path.read_bytes(), path.stat().st_mode & 0o777)
    wheel.add(f"{stem}.dist-info/METADATA", METADATA.format(version=version(), python=PYTHON).encode())
    wheel.add(f"{stem}.dist-info/WHEEL", WHEEL.format(tag=tag).encode())
    wheel.close()
    return f"{stem}-{tag}.whl"
