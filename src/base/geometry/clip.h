// Polygons cut by half-planes and half-spaces.
#pragma once

#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

// There are two other clippers in visibility/clipping: convex_polygon.h cuts a piece into both of
// its parts at once and records the origin of each edge; clip_polygons-inl.h clips a polygon in
// every lane.

/// Calls keep(corner) for the corners, in order, of the part of a loop where side(p) >= 0
/// (Sutherland & Hodgman 1974). `side` is affine; between(a, b, side(a), side(b)) is the point of
/// edge a b where it is 0. A concave loop stays one loop, with edges that run to and fro on the
/// border. Calls nothing if nothing is left.
template <class Loop, class Side, class Between, class Keep>
void clipCorners(const Loop& loop, const Side& side, const Between& between, const Keep& keep) {
  if (loop.empty()) return;
  std::size_t last = loop.size() - 1;
  double from = side(loop[last]);
  for (std::size_t k = 0; k < loop.size(); last = k++) {
    const double to = side(loop[k]);
    if ((from < 0) != (to < 0)) keep(between(loop[last], loop[k], from, to));
    if (!(to < 0)) keep(loop[k]);
    from = to;
  }
}

/// The same for points of a plane or of space.
template <class Loop, class Side, class Keep>
void clipCorners(const Loop& loop, const Side& side, const Keep& keep) {
  const auto between = [](const auto& a, const auto& b, double from, double to) {
    return a + (b - a) * (from / (from - to));
  };
  clipCorners(loop, side, between, keep);
}

/// The same in place.
template <class Vec, class Side>
void clipLoop(std::vector<Vec>& loop, std::vector<Vec>& scratch, const Side& side) {
  scratch.clear();
  clipCorners(loop, side, [&](const Vec& corner) { scratch.push_back(corner); });
  loop.swap(scratch);
}

/// Signed area, positive counter-clockwise; relative to the first corner.
inline double polygonArea(std::span<const Vec2> polygon) {
  double twice = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k - 1] - polygon[0];
    const Vec2 b = polygon[k] - polygon[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

/// The centroid of the area; the first corner if there is none.
inline Vec2 polygonCentroid(std::span<const Vec2> polygon) {
  Vec2 moment(0.0);
  double twice = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k - 1] - polygon[0];
    const Vec2 b = polygon[k] - polygon[0];
    const double area = a.x * b.y - a.y * b.x;
    moment += area / 3 * (a + b);
    twice += area;
  }
  return twice > 0 ? polygon[0] + moment / twice : polygon[0];
}

}  // namespace radiosity
