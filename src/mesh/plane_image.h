// Two coordinates for the points of a plane.
#pragma once

#include <cmath>

#include "radiosity/base.h"

namespace radiosity {

/// Leaves out the coordinate along which the normal is largest: no rounding, so a point has one
/// and the same image in every use, and what is straight or crosses stays so. Counter-clockwise
/// about the normal is counter-clockwise in the image.
class PlaneImage {
 public:
  explicit PlaneImage(const Vec3& normal) {
    const Vec3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int drop = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
    first_ = (drop + 1) % 3;
    second_ = (drop + 2) % 3;
    if (normal[drop] < 0) {
      const int other = first_;
      first_ = second_;
      second_ = other;
    }
  }
  Vec2 operator()(const Vec3& p) const { return {p[first_], p[second_]}; }

 private:
  int first_ = 0;
  int second_ = 1;
};

}  // namespace radiosity
