// Shapes of triangles in the plane, and points that would better them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <vector>

#include "base/geometry/plane_frame.h"

namespace radiosity {

/// The smallest angle of a triangle, radians.
inline double smallestOf(const Vec2& a, const Vec2& b, const Vec2& c) {
  return std::min({angleAt(c, a, b), angleAt(a, b, c), angleAt(b, c, a)});
}

/// The distance of p from the line through a and b.
inline double heightOver(const Vec2& p, const Vec2& a, const Vec2& b) {
  return std::abs(cross2(b - a, p - a)) / glm::length(b - a);
}

/// Where a point might mend the triangle p: its circumcentre, its centroid, and apexes of good
/// triangles over its shortest edge (the off-centres of Uengoer 2009).
inline std::vector<Vec2> candidatesFor(const Vec2 (&p)[3]) {
  const Vec2 a = p[1] - p[0];
  const Vec2 b = p[2] - p[0];
  const Vec2 turned(b.y * glm::dot(a, a) - a.y * glm::dot(b, b),
                    a.x * glm::dot(b, b) - b.x * glm::dot(a, a));
  std::vector<Vec2> candidates = {p[0] + turned / (2 * cross2(a, b)), (p[0] + p[1] + p[2]) / 3.0};
  int apex = 0;  // opposite the shortest edge
  for (int i = 1; i < 3; ++i) {
    if (glm::length(p[(i + 1) % 3] - p[(i + 2) % 3]) <
        glm::length(p[(apex + 1) % 3] - p[(apex + 2) % 3])) {
      apex = i;
    }
  }
  const Vec2 middle = 0.5 * (p[(apex + 1) % 3] + p[(apex + 2) % 3]);
  const Vec2 edge = p[(apex + 2) % 3] - p[(apex + 1) % 3];
  const Vec2 normal(-edge.y, edge.x);  // towards the apex: the triangle is counter-clockwise
  for (const double angle : {30.0, 45.0, 60.0, 80.0}) {
    candidates.push_back(middle + normal * (0.5 / std::tan(0.5 * glm::radians(angle))));
  }
  return candidates;
}

}  // namespace radiosity
