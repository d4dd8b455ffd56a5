// Do polygons of one surface cross or touch each other?
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry/box_tree.h"
#include "formfactor/hidden_backs.h"

namespace radiosity {
namespace {

std::span<const std::uint32_t> cornersOf(const ViewScene& scene, Index p) {
  const ViewPolygon& polygon = scene.polygons[p];
  const std::uint32_t begin = scene.loop_offset[polygon.loop_begin];
  return {scene.corners.data() + begin, scene.loop_offset[polygon.loop_end] - begin};
}

Box3 boxOf(const ViewScene& scene, Index p) {
  Box3 box;
  for (const std::uint32_t v : cornersOf(scene, p)) box.add(scene.vertices[v]);
  return box.grown(scene.coincidence);
}

double distanceToSegment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double length = glm::dot(along, along);
  const double t = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + along * t);
}

/// Is a point of the polygon's plane inside it or on its rim? Seen along the normal's largest
/// axis.
bool contains(const ViewScene& scene, Index p, const Vec3& point) {
  const ViewPolygon& polygon = scene.polygons[p];
  const Vec3 size = glm::abs(polygon.normal);
  const int drop = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  const auto flat = [&](const Vec3& v) { return Vec2(v[(drop + 1) % 3], v[(drop + 2) % 3]); };
  const Vec2 q = flat(point);
  bool inside = false;
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
    const std::uint32_t begin = scene.loop_offset[l];
    const std::uint32_t end = scene.loop_offset[l + 1];
    Vec2 a = flat(scene.vertices[scene.corners[end - 1]]);
    for (std::uint32_t k = begin; k < end; ++k) {
      const Vec2 b = flat(scene.vertices[scene.corners[k]]);
      if (distanceToSegment(q, a, b) <= scene.coincidence) return true;
      if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)) {
        inside = !inside;
      }
      a = b;
    }
  }
  return inside;
}

/// Does an edge or corner of p pierce or touch q? What p and q share does not count.
bool meets(const ViewScene& scene, Index p, Index q) {
  const ViewPolygon& polygon = scene.polygons[p];
  const ViewPolygon& plane = scene.polygons[q];
  const std::span<const std::uint32_t> theirs = cornersOf(scene, q);
  // 1 above the plane of q, -1 below, 0 in it; what q has itself is in it, and is harmless.
  const auto sideOf = [&](std::uint32_t v, bool& shared) {
    shared = std::find(theirs.begin(), theirs.end(), v) != theirs.end();
    if (shared) return 0;
    const double height = glm::dot(plane.normal, scene.vertices[v] - plane.origin);
    return int(height > scene.coincidence) - int(height < -scene.coincidence);
  };
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
    const std::uint32_t begin = scene.loop_offset[l];
    const std::uint32_t end = scene.loop_offset[l + 1];
    bool shared = false;
    std::uint32_t from = scene.corners[end - 1];
    int from_side = sideOf(from, shared);
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t to = scene.corners[k];
      const int to_side = sideOf(to, shared);
      const Vec3& b = scene.vertices[to];
      if (to_side == 0 && !shared && contains(scene, q, b)) return true;
      if (from_side * to_side < 0) {
        const Vec3& a = scene.vertices[from];
        const double ha = glm::dot(plane.normal, a - plane.origin);
        const double hb = glm::dot(plane.normal, b - plane.origin);
        if (contains(scene, q, a + (b - a) * (ha / (ha - hb)))) return true;
      }
      from = to;
      from_side = to_side;
    }
  }
  return false;
}

}  // namespace

bool isEmbedded(const ViewScene& scene, const std::vector<Index>& polygons) {
  std::vector<Box3> boxes;
  boxes.reserve(polygons.size());
  for (const Index p : polygons) boxes.push_back(boxOf(scene, p));
  const BoxTree tree(boxes);
  bool apart = true;
  for (Index i = 0; i < polygons.size() && apart; ++i) {
    tree.query(boxes[i], [&](Index j) {
      apart = j <= i ||
              (!meets(scene, polygons[i], polygons[j]) && !meets(scene, polygons[j], polygons[i]));
      return apart;
    });
  }
  return apart;
}

}  // namespace radiosity
