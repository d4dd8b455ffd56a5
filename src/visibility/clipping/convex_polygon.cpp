#include "visibility/clipping/convex_polygon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

/// A distance from a plane is a sum of four products: it is known to some units in the last place
/// of the largest.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

/// The point on the plane between a point inside and one outside it (the same bits either way).
Vec3 crossing(const Vec3& in, const Vec3& out, double in_distance, double out_distance) {
  return in + (out - in) * (in_distance / (in_distance - out_distance));
}

}  // namespace

void ConvexPolygon::assign(std::span<const Vec3> outline, const Vec3& eye) {
  clear();
  for (std::size_t k = 0; k < outline.size(); ++k) {
    corners.push_back(outline[k] - eye);
    edges.push_back(std::uint16_t(k));
  }
}

PlaneSide split(const ConvexPolygon& in, const ClipPlane& plane, std::uint16_t edge,
                ConvexPolygon* inside, ConvexPolygon* outside) {
  const std::size_t count = in.corners.size();
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  double reach = 0;
  for (const Vec3& p : in.corners) {
    const double d = plane.distance(p);
    least = std::min(least, d);
    most = std::max(most, d);
    reach = std::max(reach, glm::dot(p, p));
  }
  const double noise = kRounding * (std::sqrt(glm::dot(plane.normal, plane.normal) * reach) +
                                    std::abs(plane.offset));
  if (most <= noise || least >= -noise) {
    return most + least < 0 ? PlaneSide::outside : PlaneSide::inside;
  }
  inside->clear();
  if (outside) outside->clear();
  const auto add = [](ConvexPolygon* to, const Vec3& p, std::uint16_t label) {
    if (!to) return;
    to->corners.push_back(p);
    to->edges.push_back(label);
  };
  double distance = plane.distance(in.corners[0]);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3& p = in.corners[k];
    const Vec3& q = in.corners[k + 1 < count ? k + 1 : 0];
    const double next = plane.distance(q);
    add(distance > 0 ? inside : outside, p, in.edges[k]);
    if (distance > 0 && next <= 0) {
      const Vec3 c = crossing(p, q, distance, next);
      add(inside, c, edge);
      add(outside, c, in.edges[k]);
    } else if (distance <= 0 && next > 0) {
      const Vec3 c = crossing(q, p, next, distance);
      add(inside, c, in.edges[k]);
      add(outside, c, edge);
    }
    distance = next;
  }
  return PlaneSide::both;
}

double lambert(const ConvexPolygon& polygon, const Vec3& normal) {
  return pointToPolygon(Vec3(0.0), normal, polygon.corners);
}

}  // namespace radiosity
