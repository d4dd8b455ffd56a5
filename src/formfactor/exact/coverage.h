// The visible fraction of a target from a small picture of it, where too much stands between.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/exact/convex_polygon.h"
#include "formfactor/exact/silhouette.h"

namespace radiosity {

/// An item buffer whose picture is one target: kSide x kSide samples over its area, weighted by
/// the form-factor kernel cos cos / r^2, and one bit each for "hidden". Unlike a hemicube's
/// pixels the samples are the same in number however small the target looks.
class Coverage {
 public:
  static constexpr int kSide = 16;

  /// Places the samples on `target` (relative to the eye) and clears the picture. `shift`, in
  /// [0, 1)^2, moves them within their cells: different for every eye point of a pair, so that
  /// the points together see a finer picture.
  void begin(const ConvexPolygon& target, const Vec3& normal, const Vec2& shift);
  /// Draws one occluder. Returns false once nothing is left to be seen.
  bool draw(const BlockingCone& cone);
  /// Share of the weight that is not hidden, 0 to 1.
  double visibleFraction() const;

 private:
  std::vector<Vec3> samples_;
  std::vector<double> weights_;
  std::vector<std::uint8_t> hidden_;
  std::size_t left_ = 0;
};

}  // namespace radiosity
