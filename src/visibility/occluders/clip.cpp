#include "visibility/occluders/clip.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"

namespace radiosity {
namespace {

/// The parts of the loops inside the body; none if a plane shows that there are none.
std::vector<std::vector<Vec3>> partsInside(const OccluderPolygons& all,
                                           const OccluderPolygon& polygon, const Occluder& body,
                                           double margin) {
  std::vector<std::vector<Vec3>> parts;
  for (const Occluder::Plane& plane : body.planes) {
    const bool outside = std::all_of(polygon.corners.begin(), polygon.corners.end(), [&](Index v) {
      return glm::dot(plane.normal, all.vertices[v]) >= plane.offset - margin;
    });
    if (outside) return parts;
  }
  std::vector<Vec3> scratch;
  for (const std::vector<Index>& loop : polygon.loops) {
    std::vector<Vec3> part;
    part.reserve(loop.size());
    for (const Index v : loop) part.push_back(all.vertices[v]);
    for (const Occluder::Plane& plane : body.planes) {
      const double offset = plane.offset - margin;
      clipLoop(part, scratch, [&](const Vec3& p) { return offset - glm::dot(plane.normal, p); });
    }
    if (!part.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

double areaInside(const OccluderPolygons& all, const OccluderPolygon& polygon, const Occluder& body,
                  double margin) {
  Vec3 sum(0.0);
  for (const std::vector<Vec3>& part : partsInside(all, polygon, body, margin)) {
    sum += vectorArea(part.size(), [&](std::size_t k) { return part[k]; });
  }
  return std::abs(glm::dot(sum, polygon.normal));
}

double highestInside(const OccluderPolygons& all, const OccluderPolygon& polygon,
                     const Occluder& body, double margin) {
  double highest = -std::numeric_limits<double>::infinity();
  Vec3 sum(0.0);
  double size = 0;
  for (const std::vector<Vec3>& part : partsInside(all, polygon, body, margin)) {
    sum += vectorArea(part.size(), [&](std::size_t k) { return part[k]; });
    for (const Vec3& p : part) {
      highest = std::max(highest, glm::dot(body.planes[0].normal, p));
      size = std::max(size, glm::distance(p, part[0]));
    }
  }
  const bool any = glm::length(sum) > margin * size;
  return any ? highest : -std::numeric_limits<double>::infinity();
}

Occluder::Plane planeOf(const OccluderPolygon& polygon) { return {polygon.normal, polygon.offset}; }

bool isBehind(const OccluderPolygons& all, const OccluderPolygon& polygon,
              const Occluder::Plane& plane) {
  return std::all_of(polygon.corners.begin(), polygon.corners.end(), [&](Index v) {
    return glm::dot(plane.normal, all.vertices[v]) <= plane.offset + all.coincidence;
  });
}

Index faceThatHolds(const OccluderPolygons& all, const OccluderPolygon& polygon,
                    const Occluder& solid) {
  std::vector<std::uint8_t> on(solid.planes.size(), 1);
  for (const Index v : polygon.corners) {
    const Vec3& p = all.vertices[v];
    if (glm::distance(p, solid.centre) > solid.radius + all.coincidence) return kNone;
    for (std::size_t k = 0; k < solid.planes.size(); ++k) {
      const double height = glm::dot(solid.planes[k].normal, p) - solid.planes[k].offset;
      if (height > all.coincidence) return kNone;
      if (height < -all.coincidence) on[k] = 0;
    }
  }
  const auto face = std::find(on.begin(), on.end(), 1);
  return face == on.end() ? kNone : Index(face - on.begin());
}

Box3 boxAround(const Occluder& body, double margin) {
  Box3 box;
  for (const Vec3& corner : body.corners) box.add(corner);
  return box.grown(margin);
}

bool isEmpty(const OccluderPolygons& all, const Occluder& body, std::span<const Index> own) {
  bool empty = true;
  const auto apart = [&](const Box3& box) {
    return glm::distance(glm::clamp(body.centre, box.low, box.high), body.centre) > body.radius;
  };
  all.tree.query(boxAround(body, 0), [&](Index p) {
    if (!std::binary_search(own.begin(), own.end(), p) && !apart(all.polygons[p].box)) {
      const double inside = areaInside(all, all.polygons[p], body, all.coincidence);
      empty = inside <= all.coincidence * body.radius;
    }
    return empty;
  });
  return empty;
}

}  // namespace radiosity
