// Convex polygons in the plane cut by half-planes.
#pragma once

#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Keeps the part of a convex polygon where side(p) >= 0 (Sutherland & Hodgman 1974); `side` is
/// affine. The result is empty where nothing is left.
template <class Side>
void clipConvex(std::vector<Vec2>& polygon, std::vector<Vec2>& scratch, const Side& side) {
  scratch.clear();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2& p = polygon[k];
    const Vec2& q = polygon[(k + 1) % polygon.size()];
    const double a = side(p);
    const double b = side(q);
    if (a >= 0) scratch.push_back(p);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) scratch.push_back(p + (q - p) * (a / (a - b)));
  }
  polygon.swap(scratch);
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

}  // namespace radiosity
