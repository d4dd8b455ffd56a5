// A part of the sampled element and what its quadrature points saw.
#pragma once

#include <array>

#include "formfactor/exact/visible_part.h"
#include "radiosity/base.h"

namespace radiosity {

/// A convex quadrilateral (a triangle: its last two corners are one), integrated by 3 x 3 Gauss
/// points of the unit square, mapped bilinearly.
struct SampleCell {
  static constexpr std::size_t kPoints = 9;

  std::array<Vec3, 4> corners;
  std::array<PointView, kPoints> views{};

  struct Point {
    Vec3 position;
    double weight;  ///< area; the weights of all points add up to the cell's
  };
  Point point(std::size_t k) const;
  /// Halves both ways.
  SampleCell child(int k) const;
  double area() const;

  /// Sums over the points of weight times form factor: area times mean.
  double visible() const;
  double whole() const;
  /// Estimate of the error of visible() - fraction * whole(). Gauss points see a smooth integrand
  /// far better than any tolerance; what they do not see is a kink, where an edge of a shadow
  /// passes a corner of the target: there the second differences of the values, times a few
  /// hundredths, bound the error.
  double error(double fraction) const;
};

}  // namespace radiosity
