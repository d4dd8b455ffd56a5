#include "formfactor/hidden_backs.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace radiosity {
namespace {

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

std::span<const std::uint32_t> loopOf(const ViewScene& scene, std::uint32_t l) {
  return {scene.corners.data() + scene.loop_offset[l],
          scene.loop_offset[l + 1] - scene.loop_offset[l]};
}

template <class Visit>
void forEdges(const ViewScene& scene, Index p, Visit&& visit) {
  const ViewPolygon& polygon = scene.polygons[p];
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
    const std::span<const std::uint32_t> loop = loopOf(scene, l);
    for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
      visit(DirectedEdge(loop[last], loop[k]));
    }
  }
}

/// Triangles (first corner of the loop, edge) whose signed sum is the polygon, holes included.
template <class Visit>
void forFans(const ViewScene& scene, const std::vector<Index>& polygons, Visit&& visit) {
  for (const Index p : polygons) {
    const ViewPolygon& polygon = scene.polygons[p];
    for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
      const std::span<const std::uint32_t> loop = loopOf(scene, l);
      for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
        visit(scene.vertices[loop[0]], scene.vertices[loop[k]], scene.vertices[loop[k + 1]]);
      }
    }
  }
}

double determinant(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

bool isOneSided(const ViewScene& scene, const ViewPolygon& polygon) {
  return polygon.side[1].grid == kNone && polygon.side[1].item >= scene.patches;
}

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }
  Index find(Index x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(Index a, Index b) { parent_[find(a)] = find(b); }

 private:
  std::vector<Index> parent_;
};

}  // namespace

HiddenBacks::HiddenBacks(const ViewScene& scene)
    : scene_(scene), covered_(scene.polygons.size(), 0), surface_of_(scene.polygons.size(), kNone) {
  findCovered();
  findClosedSurfaces();
}

void HiddenBacks::findCovered() {
  std::map<std::vector<std::uint32_t>, std::vector<Index>> by_corners;
  for (Index p = 0; p < scene_.polygons.size(); ++p) {
    const ViewPolygon& polygon = scene_.polygons[p];
    std::vector<std::uint32_t> key(scene_.corners.begin() + scene_.loop_offset[polygon.loop_begin],
                                   scene_.corners.begin() + scene_.loop_offset[polygon.loop_end]);
    std::sort(key.begin(), key.end());
    by_corners[std::move(key)].push_back(p);
  }
  for (const auto& [corners, same] : by_corners) {
    for (const Index p : same) {
      covered_[p] = std::any_of(same.begin(), same.end(), [&](Index q) {
        return glm::dot(scene_.polygons[p].normal, scene_.polygons[q].normal) < 0;
      });
    }
  }
}

/// Joins one-sided polygons across edges that exactly two of them share, once each way. A set all
/// of whose edges are such is a closed oriented surface; embedded, it separates two regions.
void HiddenBacks::findClosedSurfaces() {
  std::map<DirectedEdge, std::vector<Index>> users;
  for (Index p = 0; p < scene_.polygons.size(); ++p) {
    forEdges(scene_, p, [&](const DirectedEdge& edge) { users[edge].push_back(p); });
  }
  DisjointSets sets(scene_.polygons.size());
  std::vector<std::uint8_t> open(scene_.polygons.size(), 0);
  for (const auto& [edge, polygons] : users) {
    const auto opposite = users.find({edge.second, edge.first});
    if (polygons.size() == 1 && opposite != users.end() && opposite->second.size() == 1) {
      sets.join(polygons.front(), opposite->second.front());
    } else {
      for (const Index p : polygons) open[p] = 1;
    }
  }
  std::map<Index, std::vector<Index>> members;
  for (Index p = 0; p < scene_.polygons.size(); ++p) members[sets.find(p)].push_back(p);
  for (auto& [root, polygons] : members) {
    const bool closed = std::all_of(polygons.begin(), polygons.end(), [&](Index p) {
      return !open[p] && isOneSided(scene_, scene_.polygons[p]);
    });
    if (!closed || !isEmbedded(scene_, polygons)) continue;
    ClosedSurface surface;
    surface.lower = surface.upper =
        scene_.vertices[loopOf(scene_, scene_.polygons[polygons.front()].loop_begin).front()];
    double volume = 0;
    const Vec3 centre = surface.lower;
    forFans(scene_, polygons, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      volume += determinant(a - centre, b - centre, c - centre);
      for (const Vec3& v : {a, b, c}) {
        surface.lower = glm::min(surface.lower, v);
        surface.upper = glm::max(surface.upper, v);
      }
    });
    surface.outward = volume > 0;
    for (const Index p : polygons) surface_of_[p] = Index(surfaces_.size());
    surface.polygons = std::move(polygons);
    surfaces_.push_back(std::move(surface));
  }
}

double windingNumber(const ViewScene& scene, const std::vector<Index>& polygons,
                     const Vec3& point) {
  double angle = 0;
  forFans(scene, polygons, [&](const Vec3& va, const Vec3& vb, const Vec3& vc) {
    const Vec3 a = va - point;
    const Vec3 b = vb - point;
    const Vec3 c = vc - point;
    const double la = glm::length(a);
    const double lb = glm::length(b);
    const double lc = glm::length(c);
    angle += 2 * std::atan2(determinant(a, b, c), la * lb * lc + glm::dot(a, b) * lc +
                                                      glm::dot(b, c) * la + glm::dot(c, a) * lb);
  });
  return angle / (4 * std::numbers::pi);
}

bool HiddenBacks::onFrontSide(const ClosedSurface& surface, const Vec3& eye) const {
  const bool outside_box =
      glm::any(glm::lessThan(eye, surface.lower)) || glm::any(glm::greaterThan(eye, surface.upper));
  if (outside_box) return surface.outward;
  // The value is an integer but for rounding, unless the eye lies on the surface: then no claim.
  const double front = surface.outward ? 0 : -1;
  return std::abs(windingNumber(scene_, surface.polygons, eye) - front) < 0.01;
}

void HiddenBacks::fromEye(const Vec3& eye, Index own, std::vector<std::uint8_t>& hidden) const {
  hidden = covered_;
  for (Index s = 0; s < surfaces_.size(); ++s) {
    const bool same = own != kNone && surface_of_[own] == s;
    if (!same && !onFrontSide(surfaces_[s], eye)) continue;
    for (const Index p : surfaces_[s].polygons) hidden[p] = 1;
  }
}

}  // namespace radiosity
