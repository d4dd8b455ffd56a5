#include "visibility/clipping/silhouette.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {

bool blockingCone(const Occluder& occluder, const Vec3& eye, bool with_faces, BlockingCone& cone) {
  cone.planes.clear();
  cone.labels.clear();
  cone.inside = false;
  cone.heights.clear();
  for (const Occluder::Plane& plane : occluder.planes) {
    cone.heights.push_back(glm::dot(plane.normal, eye) - plane.offset);
  }
  for (Index k = 0; k < occluder.edges.size(); ++k) {
    const Occluder::Edge& edge = occluder.edges[k];
    const bool left = cone.heights[edge.left] > 0;
    if (left == (cone.heights[edge.right] > 0)) continue;
    const Vec3 a = occluder.corners[edge.from] - eye;
    const Vec3 along = occluder.corners[edge.to] - occluder.corners[edge.from];
    // A face turns counter-clockwise seen from outside. From there the body is to the left of the
    // edges of the faces that are seen.
    const Vec3 normal = glm::cross(a, along);
    cone.planes.push_back({left ? -normal : normal, 0});
    cone.labels.push_back(std::uint16_t(k));
  }
  if (cone.planes.empty()) {
    cone.inside = !occluder.flat;
    return cone.inside;
  }
  if (with_faces) {
    for (Index k = 0; k < occluder.planes.size(); ++k) {
      const double distance = cone.heights[k];
      if (distance <= 0) continue;
      cone.planes.push_back({-occluder.planes[k].normal, -distance});
      cone.labels.push_back(std::uint16_t(occluder.edges.size() + k));
    }
  }
  return true;
}

}  // namespace radiosity
