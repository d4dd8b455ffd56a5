"""Installs the built library and builds a program of another project against it."""
import os
import pathlib
import subprocess
import tempfile
import unittest

BUILD = os.environ["RADIOSITY_BUILD_DIR"]
DATA = os.environ["RADIOSITY_SOURCE_DIR"] + "/data"

CMAKE = """cmake_minimum_required(VERSION 3.25)
project(other LANGUAGES CXX)
find_package(radiosity 0.1 REQUIRED)
add_executable(cube cube.cpp)
target_link_libraries(cube PRIVATE radiosity::radiosity)
"""

# Unit cube, one patch a face, exact form factors (Howell C-11, C-14), rho = 1/2, only the floor
# emits. The floor's radiosity was computed in high precision from the 3 x 3 system by symmetry.
PROGRAM = """#include <cstdio>
#include <vector>
#include "radiosity/form_factors.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"
using namespace radiosity;
int main() {
  const double facing = 0.199824895698387, side = (1 - facing) / 4;
  FormFactors factors;
  factors.matrix = ExchangeMatrix(std::vector<double>(6, 1.0), Precision::real);
  for (Index i = 0; i < 6; ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (Index j = 0; j < 6; ++j) {
      if (j == i) continue;
      columns.push_back(j);
      values.push_back(j == (i ^ 1u) ? facing : side);
    }
    factors.matrix.setRow(i, columns, values);
  }
  factors.fronts.assign(6, 1.0);
  factors.backs.assign(6, 0.0);
  factors.sky.assign(6, 0.0);
  SolveOptions options;
  options.tolerance = 1e-14;
  Progress quiet;
  std::vector<double> rho(6, 0.5), emission(6, 0.0);
  emission[0] = 1;
  const Solution solution = solve(factors, rho, emission, 1, options, quiet);
  std::printf("%.12f\\n", solution.radiosity[0]);
}
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
            (root / "other/cube.cpp").write_text(PROGRAM)
            run("cmake", "-G", "Ninja", "-S", str(root / "other"), "-B", str(root / "build"),
                f"-DCMAKE_PREFIX_PATH={root / 'prefix'}")
            run("cmake", "--build", str(root / "build"))
            floor = float(run(str(root / "build/cube")))
            # The solver stops at 1e-14; the rows sum to 1 to the 15 digits of the table's value.
            self.assertAlmostEqual(floor, 1.090909098107695, delta=1e-11)
            version = run(str(root / "prefix/bin/radiosity"), "--version")
            self.assertIn("0.1.0", version)
            # Pictures take a library that the program opens only now.
            picture = f"{DATA}/cornell-box.png"
            same = run(str(root / "prefix/bin/radiosity"), "compare", picture, picture)
            self.assertRegex(same, r"relative L2 difference +0\n")


if __name__ == "__main__":
    unittest.main()
