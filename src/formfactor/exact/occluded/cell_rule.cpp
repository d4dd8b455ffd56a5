#include "formfactor/exact/occluded/cell_rule.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

// Gauss-Legendre on [0, 1], two and three points.
constexpr double kReach2 = 0.28867513459481288225;  // 1 / sqrt(12)
constexpr double kReach3 = 0.38729833462074168852;  // sqrt(3 / 20)
constexpr std::array<double, 2> kNode2 = {0.5 - kReach2, 0.5 + kReach2};
constexpr std::array<double, 3> kNode3 = {0.5 - kReach3, 0.5, 0.5 + kReach3};

/// Distance of the outer points from the border.
constexpr double kMargin = 0.02;

}  // namespace

double bendOf(std::span<const double, 9> values) {
  double bend = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double* row = &values[3 * k];
    const double* column = &values[k];
    bend += kGaussWeight3[k] * std::abs(row[0] - 2 * row[1] + row[2]);
    bend += kGaussWeight3[k] * std::abs(column[0] - 2 * column[3] + column[6]);
  }
  return bend;
}

SamplePoint SampleCell::at(double u, double v) const {
  const Vec3 along_u = (corners[1] - corners[0]) * (1 - v) + (corners[2] - corners[3]) * v;
  const Vec3 along_v = (corners[3] - corners[0]) * (1 - u) + (corners[2] - corners[1]) * u;
  const Vec3 low = corners[0] + (corners[3] - corners[0]) * v;
  return {low + along_u * u, glm::length(glm::cross(along_u, along_v))};
}

SamplePoints SampleCell::points(std::size_t side) const {
  SamplePoints points;
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      SamplePoint p = side == 2 ? at(kNode2[i], kNode2[j]) : at(kNode3[i], kNode3[j]);
      p.weight *= side == 2 ? 0.25 : kGaussWeight3[i] * kGaussWeight3[j];
      points.point[points.count++] = p;
    }
  }
  return points;
}

SamplePoints SampleCell::outerPoints() const {
  SamplePoints points;
  for (const double v : {kMargin, 1 - kMargin}) {
    for (const double u : {kMargin, 1 - kMargin}) {
      points.point[points.count++] = {at(u, v).position, 0};
    }
  }
  return points;
}

SampleCell SampleCell::child(std::size_t k) const {
  const double u = k % 2 == 0 ? 0.0 : 0.5;
  const double v = k < 2 ? 0.0 : 0.5;
  return {{at(u, v).position, at(u + 0.5, v).position, at(u + 0.5, v + 0.5).position,
           at(u, v + 0.5).position}};
}

double SampleCell::area() const {
  return 0.5 * glm::length(glm::cross(corners[2] - corners[0], corners[3] - corners[1]));
}

Vec3 SampleCell::middle() const {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

}  // namespace radiosity
