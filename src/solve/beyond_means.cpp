#include "solve/beyond_means.h"

#include <algorithm>

namespace radiosity {

double powerOf(std::span<const double> area, std::span<const double> values, int bands, int band) {
  double sum = 0;
  for (std::size_t i = 0; i < area.size(); ++i) {
    sum += area[i] * values[i * std::size_t(bands) + std::size_t(band)];
  }
  return sum;
}

bool seesOut(const FormFactors& factors) {
  const auto above0 = [](double value) { return value > 0; };
  return std::ranges::any_of(factors.sky, above0) || std::ranges::any_of(factors.backs, above0);
}

std::vector<double> balanced(const FormFactors& factors, std::span<const double> more,
                             std::span<const double> irradiance, int bands) {
  std::vector<double> out(more.begin(), more.end());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], -irradiance[k]);
  if (seesOut(factors)) return out;
  const std::span<const double> area = factors.matrix->area();
  for (int b = 0; b < bands; ++b) {
    const double made = powerOf(area, out, bands, b);
    const double all = made + powerOf(area, irradiance, bands, b);
    if (!(all > 0)) continue;
    for (auto k = std::size_t(b); k < out.size(); k += std::size_t(bands)) {
      out[k] -= made / all * (irradiance[k] + out[k]);
    }
  }
  return out;
}

bool raiseToDark(std::vector<double>& more, std::span<const double> irradiance) {
  bool raised = false;
  for (std::size_t k = 0; k < more.size(); ++k) {
    if (!(irradiance[k] < 0)) continue;
    more[k] -= irradiance[k];
    raised = true;
  }
  return raised;
}

}  // namespace radiosity
