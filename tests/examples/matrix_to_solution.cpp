// Form factors of one's own become radiosities: the unit cube, a patch a face (Howell C-11, C-14),
// reflectance 1/2, only the floor emits.
#include <radiosity/radiosity.h>

#include <cstdio>
#include <memory>
#include <vector>

using namespace radiosity;

int main() try {
  const double facing = 0.199824895698387;
  const double side = (1 - facing) / 4;
  const auto matrix =
      std::make_shared<RowMatrix>(std::vector<double>(6, 1.0), Precision::double_precision);
  for (Index i = 0; i < 6; ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (Index j = 0; j < 6; ++j) {
      if (j == i) continue;
      columns.push_back(j);
      values.push_back(j == (i ^ 1U) ? facing : side);
    }
    matrix->setRow(i, columns, values);
  }
  FormFactors factors;
  factors.matrix = matrix;
  factors.fronts.assign(6, 1.0);
  factors.backs.assign(6, 0.0);
  factors.sky.assign(6, 0.0);
  SolveOptions options;
  options.tolerance = 1e-14;
  Progress quiet;
  const std::vector<double> reflectance(6, 0.5);
  std::vector<double> emission(6, 0.0);
  emission[0] = 1;
  const Solution light = solve(factors, reflectance, emission, 1, options, quiet);
  std::printf("%.12f\n", light.radiosity[0]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
