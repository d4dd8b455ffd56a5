// A part of the sampled element and its quadrature points.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// A point of a surface that stands for some of its area.
struct SamplePoint {
  Vec3 position{0.0};
  double weight = 0;  ///< area
};

/// The points of a cell by one rule; their weights add up to its area.
struct SamplePoints {
  static constexpr std::size_t kMost = 13;

  std::array<SamplePoint, kMost> point;
  std::size_t count = 0;
  std::span<const SamplePoint> all() const { return {point.data(), count}; }
};

/// Weights of the three Gauss-Legendre points on [0, 1].
inline constexpr std::array<double, 3> kGaussWeight3 = {5.0 / 18, 8.0 / 18, 5.0 / 18};

/// Second differences of the values at 3 x 3 points, along each axis, weighted across it.
double bendOf(std::span<const double, 9> values);

/// A convex quadrilateral (a triangle: its last two corners are one).
struct SampleCell {
  std::array<Vec3, 4> corners;

  /// Product Gauss points of the unit square, 2 x 2 or 3 x 3, mapped bilinearly.
  SamplePoints points(std::size_t side) const;
  /// Four points near the corners, without weight: they see edges that pass outside the others. Not
  /// at the corners, which may touch an occluder.
  SamplePoints outerPoints() const;
  /// One of four: halves both ways.
  SampleCell child(std::size_t k) const;
  double area() const;
  Vec3 middle() const;

 private:
  /// With the map's Jacobian as weight.
  SamplePoint at(double u, double v) const;
};

}  // namespace radiosity
