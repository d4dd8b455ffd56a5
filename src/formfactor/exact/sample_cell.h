// A part of the sampled element: its quadrature points, and what their values say of the error.
#pragma once

#include <array>
#include <cstdint>

#include "radiosity/base.h"

namespace radiosity {

/// A convex quadrilateral (a triangle: its last two corners are one), integrated by 3 x 3 Gauss
/// points of the unit square, mapped bilinearly.
struct SampleCell {
  static constexpr std::size_t kPoints = 9;

  std::array<Vec3, 4> corners;

  struct Point {
    Vec3 position;
    double weight;  ///< area; the weights of all points add up to the cell's
  };
  Point point(std::size_t k) const;
  /// One of four: halves both ways.
  SampleCell child(std::size_t k) const;
  double area() const;
};

/// What the points of a cell saw of one target.
struct CellValues {
  std::array<double, SampleCell::kPoints> visible;  ///< form factors
  std::array<double, SampleCell::kPoints> whole;
  std::array<std::uint64_t, SampleCell::kPoints> shape;  ///< see PointView
  bool sampled = false;

  /// Estimate of the quadrature's error in the mean of visible - fraction * whole. Gauss points
  /// see a smooth integrand far better than any tolerance; what they do not see is a kink, where
  /// an edge of a shadow passes a corner of the target: then the second differences of the values,
  /// times a few hundredths, bound the error.
  double error(double fraction) const;
};

}  // namespace radiosity
