// Elements as the quadrature of distant pairs sees them: second moments and bilinear maps, in the
// coordinates of their facet's plane, structure of arrays.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Axes of a facet's plane; x v = normal.
struct FacetFrame {
  Vec3 u{0.0}, v{0.0}, normal{0.0};
  double offset = 0;  ///< dot(normal, x) = offset on the plane
};

/// An element's shape in its facet's frame. Points are
///     x(s, t) = centroid + mean + s U + t V + s t W,   s, t in [-1, 1]
/// with density 1 + alpha s + beta t (a parallelogram has W, alpha and beta 0; a triangle is a
/// quadrilateral whose last two corners meet). Its second moments about the centroid are those of
/// the two vectors P and Q: mean of d d^T = P P^T + Q Q^T, Q along v.
struct FlatShape {
  Vec3 centroid{0.0};  ///< in space
  double cu = 0, cv = 0;
  Vec2 mean{0.0}, u{0.0}, v{0.0}, w{0.0};
  double alpha = 0, beta = 0;
  Vec2 p{0.0};
  double q = 0;       ///< Q = (0, q)
  double moment = 0;  ///< |P|^2 + |Q|^2
  double area = 0;
};

/// Bounds that choose the formula for an element, see far_kernels.h.
struct FarBounds {
  double series_limit = 0;
  double skew = 0;  ///< 0 to 1
};

/// The shape of a polygon of three or four corners, counter-clockwise.
FlatShape flatShape(std::span<const Vec3> corners, const FacetFrame& frame);

/// Columns for the vector kernels: one array a quantity.
enum FarField : std::size_t {
  kCentreUHigh,  // coordinates of the centroid in two parts: differences of nearby elements do not
  kCentreULow,   // lose digits to single precision
  kCentreVHigh,
  kCentreVLow,
  kMomentPU,
  kMomentPV,
  kMomentQ,
  kMoment,
  kArea,
  kSeriesLimit,  // these two: see far_kernels.h
  kSkew,
  kMeanU,
  kMeanV,
  kAxisUU,
  kAxisUV,
  kAxisVU,
  kAxisVV,
  kTwistU,
  kTwistV,
  kAlpha,
  kBeta,
  kFarFields
};

/// Entries behind the last that vector loads may touch.
inline constexpr std::size_t kFarPadding = 16;

template <class T>
class FarColumns {
 public:
  explicit FarColumns(std::size_t count) { resize(count); }
  void resize(std::size_t count) {
    for (auto& field : fields_) field.resize(count + kFarPadding);
  }
  void set(std::size_t k, const FlatShape& shape, const FarBounds& bounds);
  const T* field(FarField f) const { return fields_[f].data(); }

 private:
  std::array<std::vector<T>, kFarFields> fields_;
};

}  // namespace radiosity
