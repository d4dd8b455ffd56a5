#include "formfactor/exact/sample_cell.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

// Gauss-Legendre on [0, 1], three points.
constexpr double kReach = 0.38729833462074168852;  // sqrt(3/5) / 2
constexpr std::array<double, 3> kNode = {0.5 - kReach, 0.5, 0.5 + kReach};
constexpr std::array<double, 3> kWeight = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// Shares of the second differences: with shadows of one shape at all points, and else.
constexpr double kSmooth = 0.004;
constexpr double kKinked = 0.03;

}  // namespace

SampleCell::Point SampleCell::point(std::size_t k) const {
  const double u = kNode[k % 3];
  const double v = kNode[k / 3];
  const Vec3 along_u = (corners[1] - corners[0]) * (1 - v) + (corners[2] - corners[3]) * v;
  const Vec3 along_v = (corners[3] - corners[0]) * (1 - u) + (corners[2] - corners[1]) * u;
  const Vec3 low = corners[0] + (corners[3] - corners[0]) * v;
  return {low + along_u * u,
          glm::length(glm::cross(along_u, along_v)) * kWeight[k % 3] * kWeight[k / 3]};
}

SampleCell SampleCell::child(std::size_t k) const {
  const auto at = [&](double u, double v) {
    return (corners[0] * (1 - u) + corners[1] * u) * (1 - v) +
           (corners[3] * (1 - u) + corners[2] * u) * v;
  };
  const double u = 0.5 * double(k % 2);
  const double v = 0.5 * double(k / 2);
  return {{at(u, v), at(u + 0.5, v), at(u + 0.5, v + 0.5), at(u, v + 0.5)}};
}

double SampleCell::area() const {
  return 0.5 * glm::length(glm::cross(corners[2] - corners[0], corners[3] - corners[1]));
}

double CellValues::error(double fraction) const {
  std::array<double, SampleCell::kPoints> residual;
  bool one_shape = true;
  for (std::size_t k = 0; k < residual.size(); ++k) {
    residual[k] = visible[k] - fraction * whole[k];
    one_shape &= shape[k] == shape[0];
  }
  double bend = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &residual[3 * k];
    const double* column = &residual[k];
    bend += kWeight[k] * std::abs(row[0] - 2 * row[1] + row[2]);
    bend += kWeight[k] * std::abs(column[0] - 2 * column[3] + column[6]);
  }
  return bend * (one_shape ? kSmooth : kKinked);
}

}  // namespace radiosity
