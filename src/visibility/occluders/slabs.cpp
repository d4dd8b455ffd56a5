#include "visibility/occluders/slabs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "visibility/occluders/clip.h"
#include "visibility/occluders/hull.h"

namespace radiosity {
namespace {

/// The distance from a convex polygon to the first one behind it; one that lies back to back with
/// it is behind it, too.
double depthBehind(const OccluderPolygons& all, Index front) {
  const OccluderPolygon& polygon = all.polygons[front];
  Occluder shaft;
  // Lifted off the plane, so that a polygon that coincides with this one is inside by more than the
  // margin.
  shaft.planes.push_back({polygon.normal, polygon.offset + 3 * all.coincidence});
  const std::vector<Index>& loop = polygon.loops[0];
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = all.vertices[loop[k]];
    const Vec3 along = all.vertices[loop[(k + 1) % loop.size()]] - a;
    const Vec3 out = glm::normalize(glm::cross(along, polygon.normal));
    shaft.planes.push_back({out, glm::dot(out, a)});
  }
  double highest = -std::numeric_limits<double>::infinity();
  // A box wholly outside a plane of the shaft is not in it, and a box that is not above the highest
  // point found so far holds no higher one.
  const auto meets = [&](const Box3& box) {
    const Vec3 middle = 0.5 * (box.low + box.high);
    const Vec3 half = 0.5 * (box.high - box.low) + Vec3(all.coincidence);
    const auto reach = [&](const Vec3& n) { return glm::dot(half, glm::abs(n)); };
    if (glm::dot(polygon.normal, middle) + reach(polygon.normal) < highest) return false;
    return std::all_of(shaft.planes.begin(), shaft.planes.end(), [&](const Occluder::Plane& plane) {
      return glm::dot(plane.normal, middle) - reach(plane.normal) <= plane.offset;
    });
  };
  all.tree.search(meets, [&](Index p) {
    if (p != front) {
      highest = std::max(highest, highestInside(all, all.polygons[p], shaft, all.coincidence));
    }
    return true;
  });
  return polygon.offset - highest;
}

}  // namespace

std::optional<Occluder> slabBehind(const OccluderPolygons& all, Index polygon) {
  const OccluderPolygon& top = all.polygons[polygon];
  const double depth = depthBehind(all, polygon);
  if (!(depth > all.coincidence) || std::isinf(depth)) return {};
  std::vector<Vec3> points;
  for (const Index v : top.loops[0]) {
    points.push_back(all.vertices[v]);
    points.push_back(all.vertices[v] - depth * top.normal);
  }
  std::optional<Occluder> slab = convexHull(points, {{top.normal, top.offset}}, all.coincidence);
  if (!slab || !isEmpty(all, *slab, std::array<Index, 1>{polygon})) return {};
  return slab;
}

}  // namespace radiosity
