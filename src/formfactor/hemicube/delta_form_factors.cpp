#include "formfactor/hemicube/delta_form_factors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radiosity {
namespace {

constexpr double kHalfInversePi = 0.5 * std::numbers::inv_pi;

/// Antiderivative of the top face's weight, odd in both arguments.
double topIntegral(double a, double b) {
  const double ra = 1 / std::sqrt(1 + a * a);
  const double rb = 1 / std::sqrt(1 + b * b);
  return kHalfInversePi * (a * ra * std::atan(b * ra) + b * rb * std::atan(a * rb));
}

/// Antiderivative of a side face's weight at lateral position y and height z.
double sideIntegral(double y, double z) {
  const double r = 1 / std::sqrt(1 + z * z);
  return -kHalfInversePi * r * std::atan(y * r);
}

/// Running sums of `rows` rows of pixels of size 2 / resolution, the first one starting at height
/// `lower`: differences of the antiderivative between pixel corners.
template <class Integral>
std::vector<double> runningSums(int resolution, int rows, double lower, Integral integral) {
  const std::size_t count = std::size_t(resolution) + 1;
  const double size = 2.0 / resolution;
  const auto cornersAt = [&](double height) {
    std::vector<double> corners(count);
    for (std::size_t x = 0; x < count; ++x) corners[x] = integral(double(x) * size - 1, height);
    return corners;
  };
  std::vector<double> table(count * std::size_t(rows));
  std::vector<double> below = cornersAt(lower);
  for (int y = 0; y < rows; ++y) {
    std::vector<double> above = cornersAt(lower + (y + 1) * size);
    double* row = table.data() + std::size_t(y) * count;
    for (std::size_t x = 0; x < count; ++x) {
      row[x] = (above[x] - below[x]) - (above[0] - below[0]);
    }
    below = std::move(above);
  }
  return table;
}

}  // namespace

DeltaFormFactors::DeltaFormFactors(int resolution)
    : resolution_(resolution),
      top_(runningSums(resolution, resolution / 2, -1.0, topIntegral)),
      side_(runningSums(resolution, resolution / 2, 0.0, sideIntegral)) {}

const double* DeltaFormFactors::topRow(int y) const {
  return top_.data() + std::size_t(std::min(y, resolution_ - 1 - y)) * stride();
}

}  // namespace radiosity
