#include "formfactor/exact/sample_cell.h"

#include <algorithm>
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

SampleCell SampleCell::child(int k) const {
  const auto at = [&](double u, double v) {
    return (corners[0] * (1 - u) + corners[1] * u) * (1 - v) +
           (corners[3] * (1 - u) + corners[2] * u) * v;
  };
  const double u = 0.5 * (k % 2);
  const double v = 0.5 * (k / 2);
  SampleCell cell;
  cell.corners = {at(u, v), at(u + 0.5, v), at(u + 0.5, v + 0.5), at(u, v + 0.5)};
  return cell;
}

double SampleCell::area() const {
  return 0.5 * glm::length(glm::cross(corners[2] - corners[0], corners[3] - corners[1]));
}

double SampleCell::visible() const {
  double sum = 0;
  for (std::size_t k = 0; k < kPoints; ++k) sum += point(k).weight * views[k].visible;
  return sum;
}

double SampleCell::whole() const {
  double sum = 0;
  for (std::size_t k = 0; k < kPoints; ++k) sum += point(k).weight * views[k].whole;
  return sum;
}

double SampleCell::error(double fraction) const {
  std::array<double, kPoints> residual;
  bool one_shape = true;
  for (std::size_t k = 0; k < kPoints; ++k) {
    residual[k] = views[k].visible - fraction * views[k].whole;
    one_shape &= views[k].shape == views[0].shape;
  }
  double bend = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    bend += kWeight[k] * std::abs(residual[3 * k] - 2 * residual[3 * k + 1] + residual[3 * k + 2]);
    bend += kWeight[k] * std::abs(residual[k] - 2 * residual[k + 3] + residual[k + 6]);
  }
  return area() * bend * (one_shape ? kSmooth : kKinked);
}

}  // namespace radiosity
