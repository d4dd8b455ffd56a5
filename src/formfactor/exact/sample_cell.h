// A part of the sampled element: its quadrature points, and what their values say of the error.
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
  static constexpr std::size_t kMost = 9;

  std::array<SamplePoint, kMost> point;
  std::size_t count = 0;
  std::span<const SamplePoint> all() const { return {point.data(), count}; }
};

/// A convex quadrilateral (a triangle: its last two corners are one).
struct SampleCell {
  std::array<Vec3, 4> corners;

  /// Product Gauss points of the unit square, 2 x 2 or 3 x 3, mapped bilinearly.
  SamplePoints points(std::size_t side) const;
  /// One of four: halves both ways.
  SampleCell child(std::size_t k) const;
  double area() const;
  Vec3 middle() const;
};

/// What the points of a cell saw of a target.
struct CellValues {
  /// Visible minus fraction times whole form factor, by which the visible fraction's error is
  /// measured.
  std::array<double, SamplePoints::kMost> residual;
  bool one_shape = true;  ///< all points see shadows bounded by the same edges
  bool no_edge = true;    ///< and see all of the target, or nothing
};

/// Estimates of the error of a cell's mean residual, root mean squares fitted to true errors (on
/// the closed Cornell box, a cluttered and a curved scene, to within a factor of 1.5). Gauss points
/// see a smooth integrand far better than any tolerance; what they do not see is a kink, where an
/// edge of a shadow passes a corner of the target. Its size goes with how much the values change
/// from point to point (2 x 2) or how much that changes (3 x 3). A shadow that slips between the
/// points is not seen at all: where none sees an edge, the error is guessed from how far shadows
/// move across the target, `change`, and the mean of the whole form factor.
double meanError4(const CellValues& values, double change, double whole);
double meanError9(const CellValues& values, double change, double whole);

}  // namespace radiosity
