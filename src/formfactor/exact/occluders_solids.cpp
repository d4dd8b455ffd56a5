#include "formfactor/exact/occluders_solids.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <optional>

#include "formfactor/exact/occluders_hull.h"
#include "formfactor/exact/occluders_regions.h"

namespace radiosity {
namespace {

/// Polygons in convex position.
struct ConvexSet {
  std::vector<Index> polygons;
  std::vector<Index> vertices;
  std::vector<Occluder::Plane> planes;
};

class SolidSearch {
 public:
  explicit SolidSearch(const OccluderPolygons& all)
      : all_(all), users_(all.edgeUsers()), regions_(all, users_) {}

  std::vector<Occluder> run(std::vector<std::uint8_t>& taken) {
    std::vector<Occluder> solids;
    // Concave faces are left out at first: the front of a bookcase belongs to many boards at once,
    // each of which is a solid without it.
    for (const bool convex_only : {true, false}) {
      std::vector<std::uint8_t> tried = taken;
      for (Index seed = 0; seed < all_.polygons.size(); ++seed) {
        if (tried[seed] || !mayJoin(seed, convex_only)) continue;
        const ConvexSet set = grow(seed, convex_only, taken);
        for (const Index p : set.polygons) tried[p] = 1;
        std::optional<Occluder> solid = solidOf(set);
        if (!solid) continue;
        for (const Index p : set.polygons) taken[p] = 1;
        solids.push_back(std::move(*solid));
      }
    }
    return solids;
  }

 private:
  bool mayJoin(Index p, bool convex_only) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    return polygon.planar && polygon.one_sided && (polygon.convex || !convex_only);
  }

  bool isBehind(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
    for (const std::vector<Index>& loop : polygon.loops) {
      for (const Index v : loop) {
        if (glm::dot(plane.normal, all_.vertices[v]) > plane.offset + all_.coincidence) {
          return false;
        }
      }
    }
    return true;
  }

  /// Adds a polygon if the set stays in convex position.
  bool add(ConvexSet& set, Index p) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    for (const Index v : set.vertices) {
      const double height = glm::dot(polygon.normal, all_.vertices[v]) - polygon.offset;
      if (height > all_.coincidence) return false;
    }
    for (const Occluder::Plane& plane : set.planes) {
      if (!isBehind(polygon, plane)) return false;
    }
    bool new_plane = true;
    for (const Occluder::Plane& plane : set.planes) {
      new_plane = new_plane && !(glm::dot(plane.normal, polygon.normal) > 0 && on(polygon, plane));
    }
    if (new_plane) set.planes.push_back({polygon.normal, polygon.offset});
    for (const std::vector<Index>& loop : polygon.loops) {
      set.vertices.insert(set.vertices.end(), loop.begin(), loop.end());
    }
    set.polygons.push_back(p);
    return true;
  }

  bool on(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
    return isBehind(polygon, plane) && isBehind(polygon, {-plane.normal, -plane.offset});
  }

  ConvexSet grow(Index seed, bool convex_only, const std::vector<std::uint8_t>& taken) const {
    ConvexSet set;
    add(set, seed);
    std::vector<std::uint8_t> refused(all_.polygons.size(), 0);
    refused[seed] = 1;
    for (std::size_t k = 0; k < set.polygons.size(); ++k) {
      // By value: add() appends to the set.
      const OccluderPolygon& polygon = all_.polygons[set.polygons[k]];
      for (const std::vector<Index>& loop : polygon.loops) {
        for (std::size_t c = 0; c < loop.size(); ++c) {
          const auto across = users_.find({loop[(c + 1) % loop.size()], loop[c]});
          if (across == users_.end()) continue;
          for (const Index p : across->second) {
            if (taken[p] || refused[p] || !mayJoin(p, convex_only)) continue;
            refused[p] = 1;
            add(set, p);
          }
        }
      }
    }
    std::sort(set.polygons.begin(), set.polygons.end());
    std::sort(set.vertices.begin(), set.vertices.end());
    set.vertices.erase(std::unique(set.vertices.begin(), set.vertices.end()), set.vertices.end());
    return set;
  }

  std::optional<Occluder> solidOf(const ConvexSet& set) {
    if (set.planes.size() < 2) return {};
    std::vector<Vec3> points;
    for (const Index v : set.vertices) points.push_back(all_.vertices[v]);
    std::optional<Occluder> hull = convexHull(points, set.planes, all_.coincidence);
    // Polygons back to back make no solid: they are one flat occluder.
    if (!hull || hull->planes.size() < 4 || !isEmpty(*hull, set) || !isSealed(*hull, set))
      return {};
    return hull;
  }

  /// True if no polygon but those of the set comes inside, farther than the coincidence.
  bool isEmpty(const Occluder& hull, const ConvexSet& set) const {
    const Vec3 reach(hull.radius);
    for (Index p = 0; p < all_.polygons.size(); ++p) {
      const OccluderPolygon& polygon = all_.polygons[p];
      if (glm::any(glm::greaterThan(polygon.lower, hull.centre + reach)) ||
          glm::any(glm::lessThan(polygon.upper, hull.centre - reach)) ||
          std::binary_search(set.polygons.begin(), set.polygons.end(), p)) {
        continue;
      }
      const double inside = areaInside(all_, polygon, hull, all_.coincidence);
      if (inside > all_.coincidence * hull.radius) return false;
    }
    return true;
  }

  /// True if nothing gets in or out where the set does not cover the hull.
  bool isSealed(const Occluder& hull, const ConvexSet& set) {
    std::vector<Index> gaps;
    for (Index k = 0; k < hull.planes.size(); ++k) {
      if (missingArea(hull, set, k) > 0 && !allBehind(hull.planes[k])) gaps.push_back(k);
    }
    if (gaps.empty()) return true;
    if (gaps.size() == 1 && isCovered(hull, set, gaps.front())) return true;
    return regions_.isBehindOpaque(set.polygons.front());
  }

  /// Area of a face of the hull that the set leaves open; 0 if it is within rounding.
  double missingArea(const Occluder& hull, const ConvexSet& set, Index face) const {
    const Occluder::Plane& plane = hull.planes[face];
    Vec3 twice(0.0);
    double perimeter = 0;
    for (const Occluder::Edge& edge : hull.edges) {
      if (edge.left != face && edge.right != face) continue;
      const Vec3 from = hull.corners[edge.from] - hull.centre;
      const Vec3 to = hull.corners[edge.to] - hull.centre;
      twice += edge.left == face ? glm::cross(from, to) : glm::cross(to, from);
      perimeter += glm::distance(from, to);
    }
    double open = 0.5 * glm::dot(twice, plane.normal);
    for (const Index p : set.polygons) {
      const OccluderPolygon& polygon = all_.polygons[p];
      if (glm::dot(polygon.normal, plane.normal) > 0 && on(polygon, plane)) open -= polygon.area;
    }
    return open > all_.coincidence * perimeter ? open : 0;
  }

  bool allBehind(const Occluder::Plane& plane) const {
    return std::all_of(all_.vertices.begin(), all_.vertices.end(), [&](const Vec3& v) {
      return glm::dot(plane.normal, v) <= plane.offset + all_.coincidence;
    });
  }

  /// True if the open face is tied to its surroundings: each edge of the set on it has a neighbour,
  /// or polygons that face the solid cover it.
  bool isCovered(const Occluder& hull, const ConvexSet& set, Index face) const {
    const Occluder::Plane& plane = hull.planes[face];
    const auto touches = [&](Index v) {
      return glm::dot(plane.normal, all_.vertices[v]) >= plane.offset - all_.coincidence;
    };
    bool tied = true;
    for (const Index p : set.polygons) {
      if (on(all_.polygons[p], plane)) continue;
      for (const std::vector<Index>& loop : all_.polygons[p].loops) {
        for (std::size_t c = 0; c < loop.size(); ++c) {
          const Index a = loop[c];
          const Index b = loop[(c + 1) % loop.size()];
          tied = tied && (!touches(a) || !touches(b) || users_.count({b, a}) != 0);
        }
      }
    }
    if (tied) return true;
    Occluder prism = hull;
    prism.planes.erase(prism.planes.begin() + face);
    double covered = 0;
    for (const OccluderPolygon& polygon : all_.polygons) {
      if (glm::dot(polygon.normal, plane.normal) < 0 && on(polygon, plane)) {
        covered += areaInside(all_, polygon, prism, 0);
      }
    }
    return missingArea(hull, set, face) - covered <= all_.coincidence * hull.radius;
  }

  const OccluderPolygons& all_;
  std::map<OccluderEdge, std::vector<Index>> users_;
  OccluderRegions regions_;
};

}  // namespace

std::vector<Occluder> convexSolids(const OccluderPolygons& all, std::vector<std::uint8_t>& taken) {
  return SolidSearch(all).run(taken);
}

}  // namespace radiosity
