// Radiative heat exchange with form factors of one's own: two infinite plates, each all that the
// other one sees, at 1000 K and 500 K.
#include <radiosity/radiosity.h>

#include <cstdio>
#include <memory>
#include <vector>

using namespace radiosity;

int main() try {
  const auto matrix =
      std::make_shared<RowMatrix>(std::vector<double>{1.0, 1.0}, Precision::double_precision);
  const std::vector<double> all{1.0};
  for (Index i = 0; i < 2; ++i) matrix->setRow(i, std::vector<Index>{1 - i}, all);
  FormFactors factors;
  factors.matrix = matrix;
  factors.fronts = {1, 1};
  factors.backs = factors.sky = {0, 0};
  std::vector<HeatCondition> conditions(2);
  conditions[0].name = "hot";
  conditions[0].emissivity = {{{}, {0.8}}};
  conditions[0].temperature = 1000;
  conditions[1].name = "cold";
  conditions[1].emissivity = {{{}, {0.5}}};
  conditions[1].temperature = 500;
  const std::vector<Index> of_row{0, 1};
  Progress quiet;
  const HeatSolution heat = solveHeat(factors, HeatRows{conditions, of_row, {}}, {}, quiet);
  std::printf("%.9f\n", heat.net_flux[0]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
