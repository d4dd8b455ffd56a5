// Small convex polygons on the stack, clipped to half-spaces.
#pragma once

#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>

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
  for (std::size_t k = 0, last = outline.size() - 1; k < outline.size(); last = k++) {
    const double from = glm::dot(normal, outline[last]) - offset;
    const double to = glm::dot(normal, outline[k]) - offset;
    if ((from < 0) != (to < 0)) {
      front.push(outline[last] + (outline[k] - outline[last]) * (from / (from - to)));
    }
    if (!(to < 0)) front.push(outline[k]);
  }
  return front;
}

}  // namespace radiosity
