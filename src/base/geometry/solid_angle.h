// The solid angle of a triangle.
#pragma once

#include <cmath>
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

}  // namespace radiosity
