// Convex polygons as a point sees them: clipped by planes, measured by their form factor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The half-space dot(normal, p) + offset >= 0. A cone's sides pass through the viewing point,
/// which is the origin: their offset is 0.
struct ClipPlane {
  Vec3 normal{0.0};  ///< of any length
  double offset = 0;
  double distance(const Vec3& p) const {
    return normal.x * p.x + normal.y * p.y + normal.z * p.z + offset;
  }
};

/// A planar convex polygon, relative to the viewing point.
struct ConvexPolygon {
  std::vector<Vec3> corners;
  /// The origin of the edge from corner k to corner k + 1: the polygon's own edge number, or the
  /// number given with the plane that cut it.
  std::vector<std::uint16_t> edges;

  void assign(std::span<const Vec3> outline, const Vec3& eye);
  void clear() {
    corners.clear();
    edges.clear();
  }
  bool empty() const { return corners.size() < 3; }
};

enum class PlaneSide { inside, outside, both };

/// Cuts `in` into its parts on the plane's inner and outer side (Sutherland & Hodgman 1974). The
/// results are set only if there is something on both sides; `outside` may be null, neither may be
/// `in`. Both get the same points on the cut. A polygon that passes the plane by no more than
/// rounding is not cut: no slivers.
PlaneSide split(const ConvexPolygon& in, const ClipPlane& plane, std::uint16_t edge,
                ConvexPolygon* inside, ConvexPolygon* outside);

/// Form factor from the origin, on a surface of normal `normal` (unit), to a polygon above its
/// horizon that turns counter-clockwise about its own front, which faces the origin: Lambert's
/// formula as in point_to_polygon.h.
double lambert(const ConvexPolygon& polygon, const Vec3& normal);

}  // namespace radiosity
