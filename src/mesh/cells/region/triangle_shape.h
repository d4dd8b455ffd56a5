// Shapes of triangles in the plane, and points that would improve them.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "base/geometry/plane_frame.h"

namespace radiosity {

/// An angle from 0 to pi as the sides of a right triangle: the arguments that angleAt() passes to
/// std::atan2(). Most angles can be compared without the arctangent.
struct Angle {
  double opposite = 0;
  double adjacent = -1;  ///< the default is half a turn

  Angle() = default;
  Angle(double sine, double cosine) : opposite(sine), adjacent(cosine) {}
  Angle(const Vec2& a, const Vec2& apex, const Vec2& b)
      : opposite(std::abs(cross2(a - apex, b - apex))), adjacent(glm::dot(a - apex, b - apex)) {}

  double radians() const { return std::atan2(opposite, adjacent); }
  /// radians() < limit.radians(), to the bit.
  bool isBelow(const Angle& limit) const {
    return isBelow(limit, [&] { return limit.radians(); });
  }

 protected:
  /// Two angles differ by the arcsine of their cross product over the product of their lengths. If
  /// that is more than 1e-12, arctangents, good to 1e-15, give the same order.
  template <class Radians>
  bool isBelow(const Angle& limit, const Radians& radians_of_limit) const {
    const double cross = adjacent * limit.opposite - opposite * limit.adjacent;
    const double unsure =
        1e-12 * (opposite + std::abs(adjacent)) * (limit.opposite + std::abs(limit.adjacent));
    if (std::abs(cross) > unsure + std::numeric_limits<double>::min()) return cross > 0;
    return radians() < radians_of_limit();
  }
  friend struct AngleLimit;
};

/// A given angle, in degrees.
struct AngleLimit {
  explicit AngleLimit(double degrees)
      : radians(glm::radians(degrees)), angle(std::sin(radians), std::cos(radians)) {}
  /// angle.radians() < radians, to the bit.
  bool isAbove(const Angle& other) const {
    return other.isBelow(angle, [&] { return radians; });
  }

  double radians;
  Angle angle;
};

inline void lower(Angle& smallest, const Angle& angle) {
  if (angle.isBelow(smallest)) smallest = angle;
}

/// The smallest angle of a triangle.
inline Angle smallestOf(const Vec2& a, const Vec2& b, const Vec2& c) {
  Angle smallest(c, a, b);
  lower(smallest, {a, b, c});
  lower(smallest, {b, c, a});
  return smallest;
}

/// The distance of p from the line through a and b.
inline double heightOver(const Vec2& p, const Vec2& a, const Vec2& b) {
  return std::abs(cross2(b - a, p - a)) / glm::length(b - a);
}

/// Candidate points that may improve the triangle p: its circumcentre, its centroid, and apexes of
/// good triangles over its shortest edge (the off-centres of Uengoer 2009).
inline std::array<Vec2, 6> candidatesFor(const Vec2 (&p)[3]) {
  const auto heightOf = [](double angle) { return 0.5 / std::tan(0.5 * glm::radians(angle)); };
  static const std::array<double, 4> heights{heightOf(30.0), heightOf(45.0), heightOf(60.0),
                                             heightOf(80.0)};
  const Vec2 a = p[1] - p[0];
  const Vec2 b = p[2] - p[0];
  const Vec2 turned(b.y * glm::dot(a, a) - a.y * glm::dot(b, b),
                    a.x * glm::dot(b, b) - b.x * glm::dot(a, a));
  std::array<Vec2, 6> candidates = {p[0] + turned / (2 * cross2(a, b)), (p[0] + p[1] + p[2]) / 3.0};
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
  for (std::size_t k = 0; k < heights.size(); ++k) candidates[2 + k] = middle + normal * heights[k];
  return candidates;
}

}  // namespace radiosity
