// Two coordinates for the points of a plane.
#pragma once

#include <cmath>

#include "radiosity/base.h"

namespace radiosity {

/// Leaves out the coordinate along which the normal is largest. There is no rounding, so a point
/// always has the same image, and lines stay straight and crossings stay crossings.
/// Counter-clockwise about the normal is counter-clockwise in the image.
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

  /// The point with image `q` in the plane through `origin` with the image's `normal`.
  Vec3 lift(const Vec2& q, const Vec3& origin, const Vec3& normal) const {
    const int dropped = 3 - first_ - second_;
    Vec3 p = origin;
    p[first_] = q.x;
    p[second_] = q.y;
    p[dropped] -=
        (normal[first_] * (q.x - origin[first_]) + normal[second_] * (q.y - origin[second_])) /
        normal[dropped];
    return p;
  }

 private:
  int first_ = 0;
  int second_ = 1;
};

}  // namespace radiosity
