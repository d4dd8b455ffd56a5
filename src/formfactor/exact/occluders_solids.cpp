#include "formfactor/exact/occluders_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>

#include "formfactor/exact/occluders_clip.h"
#include "formfactor/exact/occluders_hull.h"
#include "formfactor/exact/occluders_regions.h"
#include "formfactor/exact/occluders_slabs.h"

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
    addPlain(taken, solids);
    addOpaque(taken, solids);
    return solids;
  }

 private:
  /// Bodies that stand for themselves, or on something.
  void addPlain(std::vector<std::uint8_t>& taken, std::vector<Occluder>& solids) {
    for (const bool convex_only : {true, false}) {
      for (Index seed = 0; seed < all_.polygons.size(); ++seed) {
        if (taken[seed] || !mayJoin(seed, convex_only)) continue;
        std::optional<Occluder> solid = grownSolid(seed, convex_only, false, taken);
        if (!solid) continue;
        take(*solid, taken);
        solids.push_back(std::move(*solid));
      }
    }
  }

  /// Bodies that touch others on several sides, so that their faces are cut or merged with others',
  /// like boards and books. Of those that only the closed surface around them makes opaque, those
  /// with much volume and most faces first.
  void addOpaque(std::vector<std::uint8_t>& taken, std::vector<Occluder>& solids) {
    struct Candidate {
      double score;
      Occluder solid;
    };
    std::vector<Candidate> candidates;
    std::array<std::vector<std::uint8_t>, 2> seen;
    seen.fill(std::vector<std::uint8_t>(all_.polygons.size(), 0));
    const auto score = [&](const Occluder& solid) {
      return areaOnFaces(solid, taken) * volumeOf(solid);
    };
    const auto consider = [&](std::optional<Occluder> solid) {
      if (solid) candidates.push_back({score(*solid), std::move(*solid)});
    };
    for (Index p = 0; p < all_.polygons.size(); ++p) {
      if (taken[p] || !mayJoin(p, false) || !regions_.isBehindOpaque(p)) continue;
      // From one face of a body its other faces give the same once more.
      for (const bool convex_only : {false, true}) {
        if (mayJoin(p, convex_only) && !seen[convex_only][p]) {
          consider(grownSolid(p, convex_only, true, taken, &seen[convex_only]));
        }
      }
      if (!mayJoin(p, true)) continue;
      std::optional<Occluder> slab = slabBehind(all_, p);
      // Alone on its slab the polygon blocks as well without it.
      if (slab && areaOnFaces(*slab, taken) > all_.polygons[p].area) consider(std::move(slab));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
    for (Candidate& candidate : candidates) {
      // Another may have taken its faces by now.
      if (!(score(candidate.solid) > 0.5 * candidate.score)) continue;
      take(candidate.solid, taken);
      solids.push_back(std::move(candidate.solid));
    }
  }

  /// `members`, if given: the polygons it was made from are marked there.
  std::optional<Occluder> grownSolid(Index seed, bool convex_only, bool opaque,
                                     const std::vector<std::uint8_t>& taken,
                                     std::vector<std::uint8_t>* members = nullptr) {
    // Several bodies may be in convex position, side by side: then carefully one of them.
    for (const bool carefully : {false, true}) {
      const ConvexSet set = grow(seed, convex_only, carefully, taken);
      std::optional<Occluder> solid = solidOf(set, opaque);
      if (!solid) continue;
      if (members != nullptr) {
        for (const Index p : set.polygons) (*members)[p] = 1;
      }
      return solid;
    }
    return {};
  }

  bool mayJoin(Index p, bool convex_only) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    return polygon.planar && polygon.one_sided && !polygon.faces_scene &&
           (polygon.convex || !convex_only);
  }

  bool isBehind(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
    return std::all_of(polygon.corners.begin(), polygon.corners.end(), [&](Index v) {
      return glm::dot(plane.normal, all_.vertices[v]) <= plane.offset + all_.coincidence;
    });
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
    if (!liesOnFace(set, polygon)) set.planes.push_back({polygon.normal, polygon.offset});
    set.vertices.insert(set.vertices.end(), polygon.corners.begin(), polygon.corners.end());
    set.polygons.push_back(p);
    return true;
  }

  bool liesOnFace(const ConvexSet& set, const OccluderPolygon& polygon) const {
    return std::any_of(set.planes.begin(), set.planes.end(), [&](const Occluder::Plane& plane) {
      return glm::dot(plane.normal, polygon.normal) > 0 && on(polygon, plane);
    });
  }

  bool on(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
    return isBehind(polygon, plane) && isBehind(polygon, {-plane.normal, -plane.offset});
  }

  /// `carefully`: no neighbours in one plane, which may belong to bodies side by side, and none
  /// with which the hull would not stay empty.
  ConvexSet grow(Index seed, bool convex_only, bool carefully,
                 const std::vector<std::uint8_t>& taken) const {
    ConvexSet set;
    add(set, seed);
    std::set<Index> met{seed};
    for (std::size_t k = 0; k < set.polygons.size(); ++k) {
      // By value: add() appends to the set.
      const OccluderPolygon& polygon = all_.polygons[set.polygons[k]];
      for (const std::vector<Index>& loop : polygon.loops) {
        for (std::size_t c = 0; c < loop.size(); ++c) {
          const auto across = users_.find({loop[(c + 1) % loop.size()], loop[c]});
          if (across == users_.end()) continue;
          for (const Index p : across->second) {
            if (taken[p] || !mayJoin(p, convex_only) || !met.insert(p).second) continue;
            if (carefully && liesOnFace(set, all_.polygons[p])) continue;
            ConvexSet before;
            if (carefully) before = set;
            if (add(set, p) && carefully && !staysEmpty(set)) set = std::move(before);
          }
        }
      }
    }
    std::sort(set.polygons.begin(), set.polygons.end());
    return set;
  }

  std::optional<Occluder> hullOf(const ConvexSet& set) const {
    std::vector<Index> vertices = set.vertices;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vec3> points;
    points.reserve(vertices.size());
    for (const Index v : vertices) points.push_back(all_.vertices[v]);
    return convexHull(points, set.planes, all_.coincidence);
  }

  bool staysEmpty(const ConvexSet& set) const {
    const std::optional<Occluder> hull = hullOf(set);
    return !hull || hull->planes.size() < 4 || isEmpty(all_, *hull, set.polygons);
  }

  std::optional<Occluder> solidOf(const ConvexSet& set, bool opaque) {
    if (set.planes.size() < 2) return {};
    std::optional<Occluder> hull = hullOf(set);
    // Polygons back to back make no solid: they are one flat occluder.
    if (!hull || hull->planes.size() < 4 || !isEmpty(all_, *hull, set.polygons) ||
        !isSealed(*hull, set, opaque)) {
      return {};
    }
    return hull;
  }

  /// Marks the polygons that lie on faces of a solid.
  void take(const Occluder& solid, std::vector<std::uint8_t>& taken) const {
    all_.tree.query(boxAround(solid, all_.coincidence), [&](Index p) {
      if (!taken[p] && faceThatHolds(all_, all_.polygons[p], solid) != kNone) taken[p] = 1;
      return true;
    });
  }

  /// Of polygons not taken yet.
  double areaOnFaces(const Occluder& solid, const std::vector<std::uint8_t>& taken) const {
    double area = 0;
    all_.tree.query(boxAround(solid, all_.coincidence), [&](Index p) {
      if (!taken[p] && faceThatHolds(all_, all_.polygons[p], solid) != kNone) {
        area += all_.polygons[p].area;
      }
      return true;
    });
    return area;
  }

  /// True if nothing gets in or out where the set does not cover the hull.
  bool isSealed(const Occluder& hull, const ConvexSet& set, bool opaque) {
    std::vector<Index> gaps;
    for (Index k = 0; k < hull.planes.size(); ++k) {
      if (missingArea(hull, set, k) > 0 && !allBehind(hull.planes[k])) gaps.push_back(k);
    }
    if (gaps.empty()) return true;
    if (gaps.size() == 1 && isCovered(hull, set, gaps.front())) return true;
    return opaque && regions_.isBehindOpaque(set.polygons.front());
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
