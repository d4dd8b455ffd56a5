#include "heat/level.h"

namespace radiosity {

namespace {

/// Backs and sky below this are 0 to rounding: the accounts are sums of up to 1e5 values.
constexpr double kRounding = 1e-13;

}  // namespace

void markAllThatSee(const ExchangeMatrix& matrix, int bands, std::vector<double>& marks) {
  const auto width = std::size_t(bands);
  bool changed = true;
  const auto update = [&](std::size_t i, const double* seen) {
    for (std::size_t b = 0; b < width; ++b) {
      double& mark = marks[i * width + b];
      if (mark != 0 || !(seen[b] > 0)) continue;
      mark = 1;
      changed = true;
    }
  };
  while (changed) {
    changed = false;
    matrix.sweep(marks, bands, update);
  }
}

bool looksOut(const FormFactors& factors, std::size_t row) {
  return factors.backs[row] + factors.sky[row] > kRounding;
}

}  // namespace radiosity
