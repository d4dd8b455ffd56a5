#include "mesh/patches/enclosures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/geometry/box.h"
#include "base/geometry/solid_angle.h"
#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/patches/edge_users.h"

namespace radiosity {
namespace {

/// Visits triangles (first corner of the loop, edge) whose signed sum is the polygons, holes
/// included.
template <class Visit>
void forFans(const PatchMesh& mesh, std::span<const Index> polygons, const Visit& visit) {
  const PlanarPolygons& all = mesh.polygons;
  for (const Index p : polygons) {
    for (std::size_t l = all.loopBegin(p); l < all.loopEnd(p); ++l) {
      const std::span<const Index> loop = all.loop(l);
      for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
        visit(mesh.vertices[loop[0]], mesh.vertices[loop[k]], mesh.vertices[loop[k + 1]]);
      }
    }
  }
}

class EnclosureSearch {
 public:
  EnclosureSearch(const PatchMesh& mesh, Progress& progress)
      : mesh_(mesh),
        progress_(progress),
        first_(firstAtSamePoint(mesh)),
        coincidence_(coincidenceOf(mesh)) {}

  Enclosures run() {
    found_.surface_of.assign(mesh_.polygons.size(), kNone);
    findCovered();
    progress_.check();
    findSurfaces();
    progress_.check();
    found_.enclosed = enclosedPatches(mesh_, first_, coincidence_, progress_);
    found_.closed = std::ranges::any_of(mesh_.area, [](double a) { return a > 0; }) &&
                    std::ranges::all_of(found_.enclosed, [](auto e) { return e != 0; });
    return std::move(found_);
  }

 private:
  void findCovered() {
    const std::vector<Vec3>& normal = mesh_.polygons.normal;
    const std::vector<Index> same = firstOnSameCorners(mesh_.polygons, first_);
    // By the first one: whether a polygon faces with it, and whether one faces it.
    std::vector<std::array<std::uint8_t, 2>> faces(normal.size(), {0, 0});
    const auto turned = [&](Index p) { return glm::dot(normal[p], normal[same[p]]) < 0 ? 1u : 0u; };
    for (Index p = 0; p < normal.size(); ++p) faces[same[p]][turned(p)] = 1;
    for (Index p = 0; p < normal.size(); ++p) {
      found_.covered.push_back(faces[same[p]][1 - turned(p)]);
    }
  }

  /// Joins polygons across edges that exactly two of them share, once each way. If a set of
  /// one-sided polygons has only such edges, it is a closed oriented surface; if embedded, it
  /// separates two regions.
  void findSurfaces() {
    const PlanarPolygons& all = mesh_.polygons;
    UnionFind sets(all.size());
    std::vector<std::uint8_t> open(all.back_is_patch);
    forEdges(edgeUsers(all, first_), [&](std::span<const EdgeUser> users) {
      if (users.size() == 2 && !users[0].reversed && users[1].reversed) {
        sets.unite(users[0].polygon, users[1].polygon);
        return;
      }
      for (const EdgeUser& user : users) open[user.polygon] = 1;
    });
    std::vector<std::pair<Index, Index>> members(all.size());  // set, polygon
    for (Index p = 0; p < all.size(); ++p) members[p] = {sets.find(p), p};
    parallelSort(members);
    for (std::size_t k = 0; k < members.size();) {
      std::vector<Index> polygons;
      const Index set = members[k].first;
      for (; k < members.size() && members[k].first == set; ++k) {
        polygons.push_back(members[k].second);
      }
      progress_.check();
      // Polygons back to back enclose nothing, and neither does one alone.
      const bool flat =
          polygons.size() == 1 || std::all_of(polygons.begin(), polygons.end(),
                                              [&](Index p) { return found_.covered[p] != 0; });
      const bool closed = !flat && std::none_of(polygons.begin(), polygons.end(),
                                                [&](Index p) { return open[p] != 0; });
      if (closed && isEmbedded(mesh_, first_, polygons, coincidence_)) {
        addSurface(std::move(polygons));
      }
    }
  }

  void addSurface(std::vector<Index> polygons) {
    ClosedSurface surface;
    const PlanarPolygons& all = mesh_.polygons;
    const Vec3 base = mesh_.vertices[all.loop(all.loopBegin(polygons.front())).front()];
    surface.lower = surface.upper = base;
    double volume = 0;
    forFans(mesh_, polygons, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      volume += glm::dot(a - base, glm::cross(b - base, c - base));
      for (const Vec3& v : {a, b, c}) {
        surface.lower = glm::min(surface.lower, v);
        surface.upper = glm::max(surface.upper, v);
      }
    });
    surface.is_solid = volume > 0;
    for (const Index p : polygons) found_.surface_of[p] = Index(found_.surfaces.size());
    surface.polygons = std::move(polygons);
    found_.surfaces.push_back(std::move(surface));
  }

  const PatchMesh& mesh_;
  Progress& progress_;
  std::vector<Index> first_;
  double coincidence_;
  Enclosures found_;
};

}  // namespace

double coincidenceOf(const PatchMesh& mesh) {
  Box3 box;
  for (const Vec3& vertex : mesh.vertices) box.add(vertex);
  if (mesh.vertices.empty()) return 0;
  return mesh.coincidence.value_or(MeshOptions().weld * glm::distance(box.low, box.high));
}

std::vector<Index> firstAtSamePoint(const PatchMesh& mesh) {
  const auto key = [&](Index v) {
    const Vec3& p = mesh.vertices[v];
    return std::tie(p.x, p.y, p.z);
  };
  std::vector<Index> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), Index(0));
  parallelSort(order,
               [&](Index a, Index b) { return key(a) < key(b) || (!(key(b) < key(a)) && a < b); });
  std::vector<Index> first(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && key(order[k - 1]) == key(order[k]);
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  return first;
}

std::vector<Index> firstOnSameCorners(const PlanarPolygons& polygons,
                                      std::span<const Index> first) {
  std::vector<std::size_t> begin{0};
  std::vector<Index> corners;
  begin.reserve(polygons.size() + 1);
  corners.reserve(polygons.corners.size());
  for (Index p = 0; p < polygons.size(); ++p) {
    for (std::size_t l = polygons.loopBegin(p); l < polygons.loopEnd(p); ++l) {
      for (const Index v : polygons.loop(l)) corners.push_back(first[v]);
    }
    std::sort(corners.begin() + std::ptrdiff_t(begin.back()), corners.end());
    begin.push_back(corners.size());
  }
  const auto cornersOf = [&](Index p) {
    return std::span(corners).subspan(begin[p], begin[p + 1] - begin[p]);
  };
  std::vector<Index> order(polygons.size());
  std::iota(order.begin(), order.end(), Index(0));
  parallelSort(order, [&](Index a, Index b) {
    const auto key = std::lexicographical_compare_three_way(
        cornersOf(a).begin(), cornersOf(a).end(), cornersOf(b).begin(), cornersOf(b).end());
    return std::is_neq(key) ? std::is_lt(key) : a < b;
  });
  std::vector<Index> same(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool again = k > 0 && std::ranges::equal(cornersOf(order[k - 1]), cornersOf(order[k]));
    same[order[k]] = again ? same[order[k - 1]] : order[k];
  }
  return same;
}

double windingNumber(const PatchMesh& mesh, std::span<const Index> polygons, const Vec3& point) {
  double angle = 0;
  const PlanarPolygons& all = mesh.polygons;
  for (const Index p : polygons) {
    for (std::size_t l = all.loopBegin(p); l < all.loopEnd(p); ++l) {
      const std::span<const Index> loop = all.loop(l);
      const auto corner = [&](std::size_t k) { return mesh.vertices[loop[k]]; };
      angle += loopSolidAngle(loop.size(), corner, point);
    }
  }
  return angle / (4 * std::numbers::pi);
}

bool isOnFrontSide(const PatchMesh& mesh, const ClosedSurface& surface, const Vec3& point) {
  const bool outside_box = glm::any(glm::lessThan(point, surface.lower)) ||
                           glm::any(glm::greaterThan(point, surface.upper));
  if (outside_box) return surface.is_solid;
  // The value is an integer but for rounding, unless the point lies on the surface: then we return
  // false.
  const double front = surface.is_solid ? 0 : -1;
  return std::abs(windingNumber(mesh, surface.polygons, point) - front) < 0.01;
}

const Enclosures& enclosuresOf(const PatchMesh& mesh, std::optional<Enclosures>& found) {
  if (mesh.enclosures) return *mesh.enclosures;
  Progress silent;
  return found.emplace(findEnclosures(mesh, silent));
}

Enclosures findEnclosures(const PatchMesh& mesh, Progress& progress) {
  return EnclosureSearch(mesh, progress).run();
}

}  // namespace radiosity
