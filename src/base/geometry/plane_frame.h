// Right-handed orthonormal frames of planes, and the vector area of polygons.
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

#include "radiosity/base.h"

namespace radiosity {

/// Coordinates in a plane: u x v = n, lengths as in space.
struct PlaneFrame {
  Vec3 origin{0.0};
  Vec3 u{1.0, 0.0, 0.0};
  Vec3 v{0.0, 1.0, 0.0};
  Vec3 n{0.0, 0.0, 1.0};

  Vec2 flat(const Vec3& p) const { return {glm::dot(p - origin, u), glm::dot(p - origin, v)}; }
  Vec3 lift(const Vec2& p) const { return origin + p.x * u + p.y * v; }
};

/// The frame of the plane through `origin` with unit `normal`, u along the part of `along` that
/// lies in the plane (which must not vanish).
inline PlaneFrame makeFrame(const Vec3& origin, const Vec3& normal, const Vec3& along) {
  PlaneFrame frame;
  frame.origin = origin;
  frame.n = normal;
  frame.u = glm::normalize(along - glm::dot(along, normal) * normal);
  frame.v = glm::cross(normal, frame.u);
  return frame;
}

/// The axis that is farthest from `normal`: a safe `along` for any plane.
inline Vec3 axisAcross(const Vec3& normal) {
  const Vec3 a = glm::abs(normal);
  if (a.x <= a.y && a.x <= a.z) return {1.0, 0.0, 0.0};
  return a.y <= a.z ? Vec3(0.0, 1.0, 0.0) : Vec3(0.0, 0.0, 1.0);
}

/// Vector area of the closed polygon point(0) .. point(count - 1) (Newell): half the sum of
/// p_k x p_{k+1}, relative to the first point so that nothing cancels far from the origin. Its
/// length is the area of a planar polygon, its direction the normal it is counter-clockwise about.
template <class PointAt>
Vec3 vectorArea(std::size_t count, const PointAt& point) {
  Vec3 sum(0.0);
  if (count < 3) return sum;
  const Vec3 base = point(0);
  Vec3 previous = point(1) - base;
  for (std::size_t k = 2; k < count; ++k) {
    const Vec3 next = point(k) - base;
    sum += glm::cross(previous, next);
    previous = next;
  }
  return 0.5 * sum;
}

inline double cross2(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

/// The angle at `apex` of the triangle a, apex, b: 0 to pi.
inline double angleAt(const Vec2& a, const Vec2& apex, const Vec2& b) {
  const Vec2 p = a - apex;
  const Vec2 q = b - apex;
  return std::atan2(std::abs(cross2(p, q)), glm::dot(p, q));
}

}  // namespace radiosity
