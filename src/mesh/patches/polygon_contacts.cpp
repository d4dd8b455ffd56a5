#include "mesh/patches/polygon_contacts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "base/geometry/box_tree.h"
#include "base/geometry/segment.h"
#include "base/parallel.h"
#include "mesh/patches/enclosures.h"

namespace radiosity {

/// Where the outline of a polygon crosses another plane, as places along the line that the planes
/// share, ascending. Between an odd and an even one the polygon has a part just below the plane
/// (above), next to the line.
struct PolygonContacts::Cuts {
  std::vector<double> below;
  std::vector<double> above;

  static bool within(const std::vector<double>& places, double at) {
    return (std::lower_bound(places.begin(), places.end(), at) - places.begin()) % 2 != 0;
  }
};

std::span<const Index> PolygonContacts::corners(Index p) const {
  const std::size_t begin = all_.corner_offset[all_.loopBegin(p)];
  return {all_.corners.data() + begin, all_.corner_offset[all_.loopEnd(p)] - begin};
}

bool PolygonContacts::hasCorner(Index p, Index vertex) const {
  const std::span<const Index> own = corners(p);
  return std::any_of(own.begin(), own.end(),
                     [&](Index other) { return first_[other] == first_[vertex]; });
}

Box3 PolygonContacts::box(Index p) const {
  Box3 out;
  for (const Index v : corners(p)) out.add(vertices_[v]);
  return out.grown(coincidence_);
}

double PolygonContacts::height(Index q, const Vec3& point) const {
  return glm::dot(all_.normal[q], point - all_.origin[q]);
}

/// 1 above the plane of q, -1 below, 0 as near as `near`.
int PolygonContacts::sideOf(Index q, const Vec3& point, double near) const {
  const double above = height(q, point);
  return int(above > near) - int(above < -near);
}

/// How far corners are off the polygon's plane: faces as patches need not be planar.
double PolygonContacts::bend(Index p) const {
  double most = 0;
  for (const Index v : corners(p)) most = std::max(most, std::abs(height(p, vertices_[v])));
  return most;
}

// Projected along the normal's largest axis.
bool PolygonContacts::contains(Index p, const Vec3& point) const {
  const Vec3 size = glm::abs(all_.normal[p]);
  const int drop = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  const auto flat = [&](const Vec3& v) { return Vec2(v[(drop + 1) % 3], v[(drop + 2) % 3]); };
  const Vec2 q = flat(point);
  bool inside = false;
  for (std::size_t l = all_.loopBegin(p); l < all_.loopEnd(p); ++l) {
    const std::span<const Index> corners = loop(l);
    Vec2 a = flat(vertices_[corners.back()]);
    for (const Index corner : corners) {
      const Vec2 b = flat(vertices_[corner]);
      if (distanceToSegment(q, a, b) <= coincidence_) return true;
      if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)) {
        inside = !inside;
      }
      a = b;
    }
  }
  return inside;
}

bool PolygonContacts::meets(Index p, Index q) const {
  // Points of q are in its plane and do not count.
  const auto sideUnlessShared = [&](Index v, bool& shared) {
    shared = hasCorner(q, v);
    return shared ? 0 : sideOf(q, vertices_[v], coincidence_);
  };
  for (std::size_t l = all_.loopBegin(p); l < all_.loopEnd(p); ++l) {
    const std::span<const Index> corners = loop(l);
    bool shared = false;
    Index from = corners.back();
    int from_side = sideUnlessShared(from, shared);
    for (const Index to : corners) {
      const int to_side = sideUnlessShared(to, shared);
      const Vec3& b = vertices_[to];
      if (to_side == 0 && !shared && contains(q, b)) return true;
      if (from_side * to_side < 0) {
        const Vec3& a = vertices_[from];
        const double ha = height(q, a);
        const double hb = height(q, b);
        if (contains(q, a + (b - a) * (ha / (ha - hb)))) return true;
      }
      from = to;
      from_side = to_side;
    }
  }
  return false;
}

PolygonContacts::Cuts PolygonContacts::cutsBy(Index q, Index p, const Vec3& along,
                                              double near) const {
  const Vec3& origin = all_.origin[q];
  Cuts cuts;
  for (std::size_t l = all_.loopBegin(p); l < all_.loopEnd(p); ++l) {
    const std::span<const Index> corners = loop(l);
    for (std::size_t k = 0, last = corners.size() - 1; k < corners.size(); last = k++) {
      const Vec3& a = vertices_[corners[last]];
      const Vec3& b = vertices_[corners[k]];
      const int side_a = sideOf(q, a, near);
      const int side_b = sideOf(q, b, near);
      // A corner in the plane is where the edge crosses it, if it does so at all.
      const auto place = [&] {
        if (side_a == 0) return glm::dot(a - origin, along);
        if (side_b == 0) return glm::dot(b - origin, along);
        const double ha = height(q, a);
        return glm::dot(a + (b - a) * (ha / (ha - height(q, b))) - origin, along);
      };
      if ((side_a < 0) != (side_b < 0)) cuts.below.push_back(place());
      if ((side_a > 0) != (side_b > 0)) cuts.above.push_back(place());
    }
  }
  std::sort(cuts.below.begin(), cuts.below.end());
  std::sort(cuts.above.begin(), cuts.above.end());
  return cuts;
}

bool PolygonContacts::passes(Index p, Index q) const {
  Vec3 along = glm::cross(all_.normal[p], all_.normal[q]);
  const double length = glm::length(along);
  if (length == 0) return false;
  along /= length;
  const double near = coincidence_ + std::max(bend(p), bend(q));
  const Cuts own = cutsBy(q, p, along, near);
  if (own.below.empty() || own.above.empty()) return false;
  Cuts other = cutsBy(p, q, along, near);
  // Both are measured from the origin of q.
  const double shift = glm::dot(all_.origin[p] - all_.origin[q], along);
  std::vector<double> ends = own.below;
  ends.insert(ends.end(), own.above.begin(), own.above.end());
  for (std::vector<double>* places : {&other.below, &other.above}) {
    for (double& place : *places) ends.push_back(place += shift);
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t k = 1; k < ends.size(); ++k) {
    if (ends[k] - ends[k - 1] <= coincidence_) continue;
    const double middle = 0.5 * (ends[k] + ends[k - 1]);
    if (Cuts::within(own.below, middle) && Cuts::within(own.above, middle) &&
        (Cuts::within(other.below, middle) || Cuts::within(other.above, middle))) {
      return true;
    }
  }
  return false;
}

bool PolygonContacts::holds(Index q, const Vec3& from, const Vec3& to) const {
  const double near = coincidence_ + bend(q);
  if (sideOf(q, from, near) != 0 || sideOf(q, to, near) != 0) return false;
  const double length = glm::distance(from, to);
  if (length <= coincidence_) return false;
  const Vec3 along = (to - from) / length;
  const Vec3 across = glm::cross(all_.normal[q], along);
  std::vector<double> ends{0, length};
  for (std::size_t l = all_.loopBegin(q); l < all_.loopEnd(q); ++l) {
    const std::span<const Index> corners = loop(l);
    for (std::size_t k = 0, last = corners.size() - 1; k < corners.size(); last = k++) {
      const Vec3 a = vertices_[corners[last]] - from;
      const Vec3 b = vertices_[corners[k]] - from;
      const double at_a = glm::dot(a, across);
      const double at_b = glm::dot(b, across);
      if ((at_a < 0) == (at_b < 0)) continue;
      const double place = glm::dot(a + (b - a) * (at_a / (at_a - at_b)), along);
      if (place > 0 && place < length) ends.push_back(place);
    }
  }
  std::sort(ends.begin(), ends.end());
  for (std::size_t k = 1; k < ends.size(); ++k) {
    if (ends[k] - ends[k - 1] <= coincidence_) continue;
    if (contains(q, from + along * (0.5 * (ends[k] + ends[k - 1])))) return true;
  }
  return false;
}

bool PolygonContacts::inPlane(Index p, Index q) const {
  const std::span<const Index> own = corners(p);
  return std::all_of(own.begin(), own.end(),
                     [&](Index v) { return sideOf(q, vertices_[v], coincidence_) == 0; });
}

bool isEmbedded(const PatchMesh& mesh, std::span<const Index> first,
                std::span<const Index> polygons, double coincidence) {
  const PolygonContacts contacts(mesh.vertices, mesh.polygons, first, coincidence);
  std::vector<Box3> boxes;
  boxes.reserve(polygons.size());
  for (const Index p : polygons) boxes.push_back(contacts.box(p));
  const BoxTree tree(boxes);
  std::atomic<bool> apart{true};
  parallelFor(polygons.size(), 64, [&](std::size_t i) {
    if (!apart.load(std::memory_order_relaxed)) return;
    tree.query(boxes[i], [&](Index j) {
      const bool is_apart = j <= i || (!contacts.meets(polygons[i], polygons[j]) &&
                                       !contacts.meets(polygons[j], polygons[i]));
      if (!is_apart) apart.store(false, std::memory_order_relaxed);
      return is_apart;
    });
  });
  return apart;
}

}  // namespace radiosity
