// Small convex polygons on the stack, clipped to half-spaces.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry/clip.h"
#include "radiosity/base.h"

namespace radiosity {

/// An element cut by one plane: a convex planar polygon of at most five corners; of six where the
/// plane is the element's own but for rounding, and every second corner is behind it.
struct FlatPolygon {
  static constexpr std::size_t kMostCorners = 6;
  std::array<Vec3, kMostCorners> corners{};
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
