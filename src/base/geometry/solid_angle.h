// The solid angle of triangles and polygons.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "radiosity/base.h"

namespace radiosity {

/// Seen from the origin, sr; > 0 where the corners run clockwise to the eye, that is, where it
/// looks at the triangle's back. Exact to rounding (van Oosterom & Strackee, "The solid angle of a
/// plane triangle", IEEE Trans. Biomed. Eng. 30, 1983). Triangles of a closed surface that faces
/// outwards sum to 4 pi about a point inside, to 0 about one outside.
inline double signedSolidAngle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  return 2 *
         std::atan2(glm::dot(a, glm::cross(b, c)),
                    la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

/// The same of a planar polygon with the corners point(0) .. point(count - 1), over a fan: parts of
/// the fan outside a concave polygon cancel.
template <class PointAt>
double loopSolidAngle(std::size_t count, const PointAt& point, const Vec3& eye) {
  double angle = 0;
  const Vec3 a = point(0) - eye;
  for (std::size_t k = 1; k + 1 < count; ++k) {
    angle += signedSolidAngle(a, point(k) - eye, point(k + 1) - eye);
  }
  return angle;
}

}  // namespace radiosity
