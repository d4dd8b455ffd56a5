// Small convex polygons on the stack, clipped to half-spaces.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry/clip.h"
#include "radiosity/base.h"

namespace radiosity {

/// A convex planar polygon of at most five corners: an element cut by one plane.
struct FlatPolygon {
  std::array<Vec3, 5> corners{};
  std::size_t count = 0;

  std::span<const Vec3> outline() const { return {corners.data(), count}; }
  void push(const Vec3& corner) { corners[count++] = corner; }
};

/// The part of a triangle or convex quadrilateral with dot(normal, x) >= offset. `normal` is unit.
inline FlatPolygon clipToFront(std::span<const Vec3> outline, const Vec3& normal, double offset) {
  FlatPolygon front;
  clipCorners(
      outline, [&](const Vec3& p) { return glm::dot(normal, p) - offset; },
      [&](const Vec3& corner) { front.push(corner); });
  return front;
}

}  // namespace radiosity
