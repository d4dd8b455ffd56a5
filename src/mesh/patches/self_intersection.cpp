// Tests whether polygons of one surface cross or touch each other.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "base/geometry/box_tree.h"
#include "base/geometry/segment.h"
#include "base/parallel.h"
#include "mesh/patches/enclosures.h"

namespace radiosity {
namespace {

/// Polygons of a mesh with equal points as one vertex.
struct Polygons {
  const PatchMesh& mesh;
  std::span<const Index> first;
  double coincidence;

  std::size_t loopBegin(Index p) const { return mesh.polygons.loopBegin(p); }
  std::size_t loopEnd(Index p) const { return mesh.polygons.loopEnd(p); }
  std::span<const Index> loop(std::size_t l) const { return mesh.polygons.loop(l); }
  const Vec3& at(Index vertex) const { return mesh.vertices[vertex]; }
  /// Corners of all loops.
  std::span<const Index> corners(Index p) const {
    const PlanarPolygons& all = mesh.polygons;
    const std::size_t begin = all.corner_offset[all.loopBegin(p)];
    return {all.corners.data() + begin, all.corner_offset[all.loopEnd(p)] - begin};
  }
  bool hasCorner(Index p, Index vertex) const {
    const std::span<const Index> own = corners(p);
    return std::any_of(own.begin(), own.end(),
                       [&](Index other) { return first[other] == first[vertex]; });
  }
  Box3 box(Index p) const {
    Box3 out;
    for (const Index v : corners(p)) out.add(at(v));
    return out.grown(coincidence);
  }
};

/// Whether a point of the polygon's plane is inside it or on its rim, projected along the normal's
/// largest axis.
bool contains(const Polygons& all, Index p, const Vec3& point) {
  const Vec3 size = glm::abs(all.mesh.polygons.normal[p]);
  const int drop = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  const auto flat = [&](const Vec3& v) { return Vec2(v[(drop + 1) % 3], v[(drop + 2) % 3]); };
  const Vec2 q = flat(point);
  bool inside = false;
  for (std::size_t l = all.loopBegin(p); l < all.loopEnd(p); ++l) {
    const std::span<const Index> loop = all.loop(l);
    Vec2 a = flat(all.at(loop.back()));
    for (const Index corner : loop) {
      const Vec2 b = flat(all.at(corner));
      if (distanceToSegment(q, a, b) <= all.coincidence) return true;
      if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)) {
        inside = !inside;
      }
      a = b;
    }
  }
  return inside;
}

/// Whether an edge or corner of p pierces or touches q. Common points do not count.
bool meets(const Polygons& all, Index p, Index q) {
  const Vec3& normal = all.mesh.polygons.normal[q];
  const Vec3& origin = all.mesh.polygons.origin[q];
  // 1 above the plane of q, -1 below, 0 in it. Points of q are in it and do not count.
  const auto sideOf = [&](Index v, bool& shared) {
    shared = all.hasCorner(q, v);
    if (shared) return 0;
    const double height = glm::dot(normal, all.at(v) - origin);
    return int(height > all.coincidence) - int(height < -all.coincidence);
  };
  for (std::size_t l = all.loopBegin(p); l < all.loopEnd(p); ++l) {
    const std::span<const Index> loop = all.loop(l);
    bool shared = false;
    Index from = loop.back();
    int from_side = sideOf(from, shared);
    for (const Index to : loop) {
      const int to_side = sideOf(to, shared);
      const Vec3& b = all.at(to);
      if (to_side == 0 && !shared && contains(all, q, b)) return true;
      if (from_side * to_side < 0) {
        const Vec3& a = all.at(from);
        const double ha = glm::dot(normal, a - origin);
        const double hb = glm::dot(normal, b - origin);
        if (contains(all, q, a + (b - a) * (ha / (ha - hb)))) return true;
      }
      from = to;
      from_side = to_side;
    }
  }
  return false;
}

}  // namespace

bool isEmbedded(const PatchMesh& mesh, std::span<const Index> first,
                std::span<const Index> polygons, double coincidence) {
  const Polygons all{mesh, first, coincidence};
  std::vector<Box3> boxes;
  boxes.reserve(polygons.size());
  for (const Index p : polygons) boxes.push_back(all.box(p));
  const BoxTree tree(boxes);
  std::atomic<bool> apart{true};
  parallelFor(polygons.size(), 64, [&](std::size_t i) {
    if (!apart.load(std::memory_order_relaxed)) return;
    tree.query(boxes[i], [&](Index j) {
      const bool is_apart = j <= i || (!meets(all, polygons[i], polygons[j]) &&
                                       !meets(all, polygons[j], polygons[i]));
      if (!is_apart) apart.store(false, std::memory_order_relaxed);
      return is_apart;
    });
  });
  return apart;
}

}  // namespace radiosity
