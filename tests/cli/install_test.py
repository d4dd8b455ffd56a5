"""Installs the built library and builds a program of another project against it."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

BUILD = os.environ["RADIOSITY_BUILD_DIR"]
ROOT = pathlib.Path(os.environ["RADIOSITY_SOURCE_DIR"])

CMAKE = """cmake_minimum_required(VERSION 3.25)
project(other LANGUAGES CXX)
find_package(radiosity 0.1 REQUIRED)
file(GLOB examples *.cpp)
foreach(example ${examples})
  get_filename_component(name ${example} NAME_WE)
  add_executable(${name} ${example})
  target_link_libraries(${name} PRIVATE radiosity::radiosity)
endforeach()
"""


class Install(unittest.TestCase):
    def test_another_project_finds_and_uses_the_package(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)

            def run(*command):
                done = subprocess.run(command, capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                return done.stdout

            run("cmake", "--install", BUILD, "--prefix", str(root / "prefix"))
            (root / "other").mkdir()
            (root / "other/CMakeLists.txt").write_text(CMAKE)
            for example in (ROOT / "tests/examples").glob("*.cpp"):
                shutil.copy(example, root / "other")
            of_readme = re.search(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
            (root / "other/readme.cpp").write_text(of_readme.group(1))
            run("cmake", "-G", "Ninja", "-S", str(root / "other"), "-B", str(root / "build"),
                f"-DCMAKE_PREFIX_PATH={root / 'prefix'}")
            run("cmake", "--build", str(root / "build"))
            floor = float(run(str(root / "build/matrix_to_solution")))
            # Computed in high precision from the 3 x 3 system by symmetry. The solver stops at
            # 1e-14; the rows sum to 1 to the 15 digits of the table's value.
            self.assertAlmostEqual(floor, 1.090909098107695, delta=1e-11)
            squares = float(run(str(root / "build/triangles_to_form_factors")))
            # Howell C-11; the default tolerance leaves 1e-5 to closed forms, and six digits are
            # printed.
            self.assertAlmostEqual(squares, 0.199824895698387, delta=3e-6)
            plates = float(run(str(root / "build/heat_between_plates")))
            # sigma (1000^4 - 500^4) / (1/.8 + 1/.5 - 1), nine digits printed.
            self.assertAlmostEqual(plates, 23626.56007993512, delta=2e-9)
            drawn = root / "cornell.png"
            said = run(str(root / "build/scene_to_picture"), f"{ROOT}/data/cornell-box.obj", str(drawn))
            self.assertIn("converged", said)
            self.assertGreater(drawn.stat().st_size, 1000)
            again = [str(root / "build/solve_again"), f"{ROOT}/data/cornell-box.obj", str(root / "s.h5")]
            self.assertEqual(run(*again).count("made"), 3)
            self.assertEqual(run(*again).count("reused"), 3)
            (root / "data").symlink_to(ROOT / "data")
            subprocess.run([root / "build/readme"], cwd=root, check=True)
            self.assertGreater((root / "lit.png").stat().st_size, 1000)
            # Without CMake.
            if shutil.which("pkg-config"):
                path = {**os.environ, "PKG_CONFIG_PATH": str(next(root.glob("prefix/**/pkgconfig")))}
                flags = subprocess.run(["pkg-config", "--cflags", "--libs", "radiosity"], env=path,
                                       capture_output=True, text=True, check=True).stdout.split()
                run("c++", "-std=c++20", str(root / "other/readme.cpp"), "-o", str(root / "plain"), *flags)
            version = run(str(root / "prefix/bin/radiosity"), "--version")
            self.assertIn("0.1.0", version)
            # Assimp's formats take a program beside the library.
            groups = ["0", "SECTION", "2", "ENTITIES", "0", "3DFACE", "8", "roof"]
            for k, (x, y) in enumerate(["00", "10", "11", "01"]):
                groups += [f"1{k}", x, f"2{k}", y, f"3{k}", "2"]
            (root / "a.dxf").write_text("\n".join([*groups, "0", "ENDSEC", "0", "EOF", ""]))
            self.assertIn("1 face", run(str(root / "prefix/bin/radiosity"), "info", str(root / "a.dxf")))
            # Pictures take a library that the program opens only now.
            picture = f"{ROOT}/data/cornell-box.png"
            same = run(str(root / "prefix/bin/radiosity"), "compare", picture, picture)
            self.assertRegex(same, r"relative L2 difference +0\n")

    def test_what_is_not_built_is_left_out_and_named(self):
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder, "build")
            prefix = pathlib.Path(folder, "prefix")
            # A copy of the build folder in which only radiosity_cli was built, as by tools/demo.
            for script in pathlib.Path(BUILD).rglob("cmake_install.cmake"):
                copy = build / script.relative_to(BUILD)
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_text(script.read_text().replace(BUILD, str(build)))

            def install(*component):
                return subprocess.run(["cmake", "--install", build, "--prefix", prefix, *component],
                                      capture_output=True, text=True)

            nothing = install()
            self.assertEqual(nothing.returncode, 0, nothing.stderr)
            self.assertFalse(prefix.exists())
            self.assertIn("not built: program; ", nothing.stdout)
            for name in ["radiosity", "radiosity-assimp", *pathlib.Path(BUILD).glob("libradiosity_*.so")]:
                shutil.copy(pathlib.Path(BUILD, name), build)
            shutil.copytree(pathlib.Path(BUILD, "share"), build / "share")
            done = install()
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, "not built: library; .*--target radiosity\n")
            self.assertFalse((prefix / "include").exists())
            self.assertTrue((prefix / "share/man/man1/radiosity-render.1").exists())

            def self_test():
                return subprocess.run([prefix / "bin/radiosity", "--self-test"], capture_output=True, text=True)

            self.assertEqual(self_test().returncode, 0)
            (prefix / "lib/libradiosity_images.so").rename(prefix / "elsewhere.so")
            broken = self_test()
            self.assertEqual(broken.returncode, 1)
            self.assertRegex(broken.stderr, "^radiosity: libradiosity_images.so cannot be used .*\n$")
            asked_for = install("--component", "library")
            self.assertNotEqual(asked_for.returncode, 0)
            self.assertIn("--target radiosity", asked_for.stderr)


if __name__ == "__main__":
    unittest.main()
