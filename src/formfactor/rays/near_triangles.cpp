#include "formfactor/rays/near_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/geometry/box_tree.h"
#include "base/geometry/plane_frame.h"
#include "base/parallel.h"

namespace radiosity {
namespace {

/// In scenes of size 1: rays start kRayLift (2e-7) before their surface, and the places where they
/// meet the planes of large triangles are off by about as much.
constexpr double kNear = 4e-7;
/// The sine of the largest angle between planes that count as nearly parallel. Steeper ones are
/// near each other in a strip of 4e-6 along the line in which they meet.
constexpr double kSteepest = 0.1;

using Triangle = std::array<Vec3, 3>;
using Range = std::array<double, 2>;

template <class Points, class Along>
Range rangeOf(const Points& points, const Along& along) {
  Range range{along(points[0]), along(points[0])};
  for (const auto& point : points) {
    const double at = along(point);
    range = {std::min(range[0], at), std::max(range[1], at)};
  }
  return range;
}

/// Whether triangles of a plane share more than a strip of the width `least`: none of their edges'
/// normals separates them.
bool overlap(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b, double least) {
  const auto separates = [&](const Vec2& from, const Vec2& to) {
    const Vec2 edge = to - from;
    const double length = glm::length(edge);
    if (!(length > 0)) return false;
    const auto across = [&](const Vec2& p) { return cross2(edge, p - from) / length; };
    const Range of_a = rangeOf(a, across);
    const Range of_b = rangeOf(b, across);
    return std::min(of_a[1], of_b[1]) - std::max(of_a[0], of_b[0]) <= least;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    if (separates(a[k], a[(k + 1) % 3]) || separates(b[k], b[(k + 1) % 3])) return false;
  }
  return true;
}

class Search {
 public:
  Search(const ViewScene& scene, const ViewTriangles& triangles)
      : scene_(scene), triangles_(triangles) {
    std::vector<Box3> boxes(triangles.triangles.size());
    parallelFor(boxes.size(), 4096, [&](std::size_t t) {
      for (const Vec3& corner : corners(t)) boxes[t].add(corner);
    });
    tree_ = BoxTree(boxes);
  }

  bool isNearAny(std::size_t t) const {
    const Triangle own = corners(t);
    const ViewPolygon& polygon = polygonOf(t);
    Box3 box;
    for (const Vec3& corner : own) box.add(corner);
    box = box.grown(kNear);
    bool found = false;
    tree_.search([&](const Box3& other) { return other.meets(box) && meetsPlane(other, polygon); },
                 [&](Index other) {
                   found = isNear(own, polygon, other);
                   return !found;
                 });
    return found;
  }

 private:
  Triangle corners(std::size_t t) const {
    const auto& [a, b, c] = triangles_.triangles[t];
    return {triangles_.vertices[a], triangles_.vertices[b], triangles_.vertices[c]};
  }
  const ViewPolygon& polygonOf(std::size_t t) const {
    return scene_.polygons[triangles_.polygon_of[t]];
  }

  static bool meetsPlane(const Box3& box, const ViewPolygon& polygon) {
    const double reach = glm::dot(glm::abs(polygon.normal), 0.5 * box.size()) + kNear;
    return std::abs(glm::dot(polygon.normal, box.centre() - polygon.origin)) <= reach;
  }

  bool isNear(const Triangle& own, const ViewPolygon& polygon, Index other) const {
    const ViewPolygon& with = polygonOf(other);
    if (&with == &polygon) return false;
    if (glm::length(glm::cross(polygon.normal, with.normal)) > kSteepest) return false;
    const Triangle theirs = corners(other);
    const auto comesNear = [](const Triangle& points, const ViewPolygon& plane) {
      const Range height =
          rangeOf(points, [&](const Vec3& p) { return glm::dot(plane.normal, p - plane.origin); });
      return height[0] <= kNear && height[1] >= -kNear;
    };
    if (!comesNear(theirs, polygon) || !comesNear(own, with)) return false;
    const PlaneFrame frame = makeFrame(own[0], polygon.normal, axisAcross(polygon.normal));
    const auto flat = [&](const Triangle& points) {
      return std::array{frame.flat(points[0]), frame.flat(points[1]), frame.flat(points[2])};
    };
    return overlap(flat(own), flat(theirs), scene_.coincidence);
  }

  const ViewScene& scene_;
  const ViewTriangles& triangles_;
  BoxTree tree_;
};

}  // namespace

std::vector<std::uint8_t> nearTriangles(const ViewScene& scene, const ViewTriangles& triangles) {
  const Search search(scene, triangles);
  std::vector<std::uint8_t> near(triangles.triangles.size(), 0);
  parallelFor(near.size(), 256, [&](std::size_t t) { near[t] = search.isNearAny(t) ? 1 : 0; });
  if (std::ranges::find(near, 1) == near.end()) near.clear();
  return near;
}

}  // namespace radiosity
