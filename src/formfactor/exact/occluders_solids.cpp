#include "formfactor/exact/occluders_solids.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <set>

#include "formfactor/exact/convex_groups.h"
#include "formfactor/exact/occluders_clip.h"
#include "formfactor/exact/occluders_hull.h"
#include "formfactor/exact/occluders_regions.h"
#include "formfactor/exact/occluders_slabs.h"

namespace radiosity {
namespace {

/// Polygons in convex position.
struct ConvexSet {
  /// A polygon and the plane that it lies on, into `planes`.
  using Member = ConvexSolid::OnFace;
  std::vector<Member> members;
  std::vector<Index> vertices;
  std::vector<Occluder::Plane> planes;
  /// Of Growth::known: planes by ConvexGroups::levelWith().
  std::map<Index, std::vector<Index>> faces_of_level;

  std::vector<Index> polygons() const {
    std::vector<Index> out;
    out.reserve(members.size());
    for (const Member& m : members) out.push_back(m.polygon);
    return out;
  }
};

/// How a set is grown.
enum class Growth {
  greedy,
  careful,  ///< no neighbours in one plane, which may belong to bodies side by side, and none
            ///< with which the hull would not stay empty
  known,    ///< all that come into question are known to be in convex position
};

class SolidSearch {
 public:
  SolidSearch(const OccluderPolygons& all, Progress& progress)
      : all_(all),
        progress_(progress),
        users_(all.edgeUsers()),
        regions_(all, users_),
        groups_(all, users_, candidates()) {
    forget();
  }

  std::vector<ConvexSolid> run(std::vector<std::uint8_t>& taken) {
    std::vector<ConvexSolid> solids;
    addPlain(taken, solids);
    forget();  // some of them may be solids where surfaces around them are opaque
    addOpaque(taken, solids);
    return solids;
  }

 private:
  /// Drops what is known of sets that make no solid.
  void forget() {
    failed_.clear();
    tried_.clear();
    given_up_.fill(std::vector<std::uint8_t>(all_.polygons.size(), 0));
  }

  /// Bodies that stand for themselves, or on something.
  void addPlain(std::vector<std::uint8_t>& taken, std::vector<ConvexSolid>& solids) {
    for (const bool convex_only : {true, false}) {
      for (Index seed = 0; seed < all_.polygons.size(); ++seed) {
        progress_.check();
        if (taken[seed] || !mayJoin(seed, convex_only)) continue;
        std::optional<ConvexSolid> solid = grownSolid(seed, convex_only, false, taken);
        if (!solid) continue;
        take(*solid, taken);
        solids.push_back(std::move(*solid));
      }
    }
  }

  /// Bodies that touch others on several sides, so that their faces are cut or merged with others',
  /// like boards and books. Of those that only the closed surface around them makes opaque, those
  /// with much volume and most faces first.
  void addOpaque(std::vector<std::uint8_t>& taken, std::vector<ConvexSolid>& solids) {
    struct Candidate {
      double score;
      ConvexSolid solid;
    };
    std::vector<Candidate> candidates;
    std::array<std::vector<std::uint8_t>, 2> seen;
    seen.fill(std::vector<std::uint8_t>(all_.polygons.size(), 0));
    const auto score = [&](const ConvexSolid& solid) {
      return areaOnFaces(solid, taken) * volumeOf(solid.body);
    };
    const auto consider = [&](std::optional<ConvexSolid> solid) {
      if (solid) candidates.push_back({score(*solid), std::move(*solid)});
    };
    for (Index p = 0; p < all_.polygons.size(); ++p) {
      progress_.check();
      if (taken[p] || !mayJoin(p, false) || isCurved(p) || !regions_.isBehindOpaque(p)) continue;
      // From one face of a body its other faces give the same once more.
      for (const bool convex_only : {false, true}) {
        if (mayJoin(p, convex_only) && !seen[convex_only][p]) {
          consider(grownSolid(p, convex_only, true, taken, &seen[convex_only]));
        }
      }
      if (!mayJoin(p, true) || groups_.isLarge(p)) continue;
      std::optional<ConvexSolid> slab = slabSolid(p);
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

  /// Part of a curved surface that is no convex body as a whole.
  bool isCurved(Index p) const { return groups_.isLarge(p) && !groups_.isConvex(p); }

  std::optional<ConvexSolid> slabSolid(Index p) const {
    std::optional<Occluder> body = slabBehind(all_, p);
    if (!body) return {};
    ConvexSolid slab{std::move(*body), {}};
    findOnFaces(slab, {});
    return slab;
  }

  /// `members`, if given: the polygons it was made from are marked there.
  std::optional<ConvexSolid> grownSolid(Index seed, bool convex_only, bool opaque,
                                        const std::vector<std::uint8_t>& taken,
                                        std::vector<std::uint8_t>* members = nullptr) {
    if (isCurved(seed)) return {};
    const bool large = groups_.isLarge(seed);
    // From one polygon of a curved body its others give the same once more.
    if (large && !tried_.insert({groups_.of(seed), convex_only}).second) return {};
    // Several bodies may be in convex position, side by side: then carefully one of them.
    const std::vector<Growth> ways = large ? std::vector<Growth>{Growth::known}
                                           : std::vector<Growth>{Growth::greedy, Growth::careful};
    for (const Growth way : ways) {
      std::vector<std::uint8_t>& given_up = given_up_[convex_only];
      if (way == Growth::careful && given_up[seed] != 0) continue;
      const ConvexSet set = grow(seed, convex_only, way, taken);
      if (way == Growth::careful) {
        // From one of them the others give much the same once more, and each takes a hull for every
        // polygon that might join.
        for (const ConvexSet::Member& m : set.members) given_up[m.polygon] = 1;
      }
      std::vector<Index> key = set.polygons();
      if (!large && failed_.count(key) != 0) continue;
      std::optional<ConvexSolid> solid = solidOf(set, opaque);
      if (!solid) {
        if (!large) failed_.insert(std::move(key));
        continue;
      }
      if (members != nullptr) {
        for (const ConvexSet::Member& m : set.members) (*members)[m.polygon] = 1;
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

  std::vector<std::uint8_t> candidates() const {
    std::vector<std::uint8_t> out(all_.polygons.size());
    for (Index p = 0; p < out.size(); ++p) out[p] = mayJoin(p, false) ? 1 : 0;
    return out;
  }

  /// Adds a polygon if the set stays in convex position.
  bool add(ConvexSet& set, Index p) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    for (const Index v : set.vertices) {
      const double height = glm::dot(polygon.normal, all_.vertices[v]) - polygon.offset;
      if (height > all_.coincidence) return false;
    }
    for (const Occluder::Plane& plane : set.planes) {
      if (!isBehind(all_, polygon, plane)) return false;
    }
    append(set, p, faceOf(set, polygon));
    return true;
  }

  /// `face`: kNone for one of its own.
  void append(ConvexSet& set, Index p, Index face) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    if (face == kNone) {
      face = Index(set.planes.size());
      set.planes.push_back(planeOf(polygon));
    }
    set.vertices.insert(set.vertices.end(), polygon.corners.begin(), polygon.corners.end());
    set.members.push_back({p, face});
  }

  /// The first face of the set that a polygon lies on, or kNone.
  Index faceOf(const ConvexSet& set, const OccluderPolygon& polygon) const {
    const auto face =
        std::find_if(set.planes.begin(), set.planes.end(), [&](const Occluder::Plane& plane) {
          return glm::dot(plane.normal, polygon.normal) > 0 && on(polygon, plane);
        });
    return face == set.planes.end() ? kNone : Index(face - set.planes.begin());
  }

  bool on(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
    return isBehind(all_, polygon, plane) &&
           isBehind(all_, polygon, {-plane.normal, -plane.offset});
  }

  ConvexSet grow(Index seed, bool convex_only, Growth way,
                 const std::vector<std::uint8_t>& taken) const {
    ConvexSet set;
    join(set, seed, way == Growth::known ? way : Growth::greedy);
    std::set<Index> met{seed};
    for (std::size_t k = 0; k < set.members.size(); ++k) {
      for (const std::vector<Index>& loop : all_.polygons[set.members[k].polygon].loops) {
        for (std::size_t c = 0; c < loop.size(); ++c) {
          const auto across = users_.find({loop[(c + 1) % loop.size()], loop[c]});
          if (across == users_.end()) continue;
          for (const Index p : across->second) {
            if (taken[p] || !mayJoin(p, convex_only) || met.count(p) != 0) continue;
            if (way == Growth::known && groups_.of(p) != groups_.of(seed)) continue;
            met.insert(p);
            join(set, p, way);
          }
        }
      }
    }
    std::sort(set.members.begin(), set.members.end(),
              [](const auto& a, const auto& b) { return a.polygon < b.polygon; });
    return set;
  }

  /// Adds a polygon, if it may be.
  void join(ConvexSet& set, Index p, Growth way) const {
    const OccluderPolygon& polygon = all_.polygons[p];
    if (way == Growth::known) {
      std::vector<Index>& faces = set.faces_of_level[groups_.levelWith(p)];
      const auto face = std::find_if(faces.begin(), faces.end(),
                                     [&](Index k) { return on(polygon, set.planes[k]); });
      if (face != faces.end()) {
        append(set, p, *face);
      } else {
        faces.push_back(Index(set.planes.size()));
        append(set, p, kNone);
      }
      return;
    }
    if (way == Growth::greedy) {
      add(set, p);
      return;
    }
    if (faceOf(set, polygon) != kNone) return;
    ConvexSet before = set;
    if (add(set, p) && !staysEmpty(set)) set = std::move(before);
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
    return !hull || hull->planes.size() < 4 || isEmpty(all_, *hull, ascending(set));
  }

  static std::vector<Index> ascending(const ConvexSet& set) {
    std::vector<Index> polygons = set.polygons();
    std::sort(polygons.begin(), polygons.end());
    return polygons;
  }

  std::optional<ConvexSolid> solidOf(const ConvexSet& set, bool opaque) {
    if (set.planes.size() < 2) return {};
    std::optional<Occluder> hull = hullOf(set);
    // Polygons back to back make no solid: they are one flat occluder.
    if (!hull || hull->planes.size() < 4 || !isEmpty(all_, *hull, ascending(set)) ||
        !isSealed(*hull, set, opaque)) {
      return {};
    }
    ConvexSolid solid{std::move(*hull), {}};
    findOnFaces(solid, set.members);
    return solid;
  }

  /// `members`: ascending; of them it is known.
  void findOnFaces(ConvexSolid& solid, const std::vector<ConvexSet::Member>& members) const {
    all_.tree.query(boxAround(solid.body, all_.coincidence), [&](Index p) {
      const auto known =
          std::lower_bound(members.begin(), members.end(), p,
                           [](const ConvexSet::Member& m, Index q) { return m.polygon < q; });
      const bool is_known = known != members.end() && known->polygon == p;
      const Index face = is_known ? known->face : faceThatHolds(all_, all_.polygons[p], solid.body);
      if (face != kNone) solid.on_faces.push_back({p, face});
      return true;
    });
    std::sort(solid.on_faces.begin(), solid.on_faces.end(),
              [](const auto& a, const auto& b) { return a.polygon < b.polygon; });
  }

  /// Marks the polygons that lie on faces of a solid.
  static void take(const ConvexSolid& solid, std::vector<std::uint8_t>& taken) {
    for (const ConvexSolid::OnFace& on : solid.on_faces) taken[on.polygon] = 1;
  }

  /// Of polygons not taken yet.
  double areaOnFaces(const ConvexSolid& solid, const std::vector<std::uint8_t>& taken) const {
    double area = 0;
    for (const ConvexSolid::OnFace& on : solid.on_faces) {
      if (!taken[on.polygon]) area += all_.polygons[on.polygon].area;
    }
    return area;
  }

  /// True if nothing gets in or out where the set does not cover the hull.
  bool isSealed(const Occluder& hull, const ConvexSet& set, bool opaque) {
    const std::vector<double> missing = missingAreas(hull, set);
    std::vector<Index> gaps;
    for (Index k = 0; k < hull.planes.size() && gaps.size() < 2; ++k) {
      const Occluder::Plane& plane = hull.planes[k];
      if (missing[k] > 0 && !all_.allBehind(plane.normal, plane.offset, all_.coincidence)) {
        gaps.push_back(k);
      }
    }
    if (gaps.empty()) return true;
    if (gaps.size() == 1 && isCovered(hull, set, gaps.front(), missing[gaps.front()])) return true;
    return opaque && regions_.isBehindOpaque(set.members.front().polygon);
  }

  /// Areas of the hull's faces that the set leaves open; 0 if within rounding.
  std::vector<double> missingAreas(const Occluder& hull, const ConvexSet& set) const {
    std::vector<Vec3> twice(hull.planes.size(), Vec3(0.0));
    std::vector<double> perimeter(hull.planes.size(), 0.0);
    for (const Occluder::Edge& edge : hull.edges) {
      const Vec3 from = hull.corners[edge.from] - hull.centre;
      const Vec3 to = hull.corners[edge.to] - hull.centre;
      twice[edge.left] += glm::cross(from, to);
      twice[edge.right] += glm::cross(to, from);
      perimeter[edge.left] += glm::distance(from, to);
      perimeter[edge.right] += glm::distance(from, to);
    }
    std::vector<double> open(hull.planes.size());
    for (Index k = 0; k < open.size(); ++k) {
      open[k] = 0.5 * glm::dot(twice[k], hull.planes[k].normal);
    }
    for (const ConvexSet::Member& m : set.members) open[m.face] -= all_.polygons[m.polygon].area;
    for (Index k = 0; k < open.size(); ++k) {
      if (!(open[k] > all_.coincidence * perimeter[k])) open[k] = 0;
    }
    return open;
  }

  /// True if the open face is tied to its surroundings: each edge of the set on it has a neighbour,
  /// or polygons that face the solid cover it.
  bool isCovered(const Occluder& hull, const ConvexSet& set, Index face, double missing) const {
    const Occluder::Plane& plane = hull.planes[face];
    const auto touches = [&](Index v) {
      return glm::dot(plane.normal, all_.vertices[v]) >= plane.offset - all_.coincidence;
    };
    bool tied = true;
    for (const ConvexSet::Member& m : set.members) {
      const OccluderPolygon& polygon = all_.polygons[m.polygon];
      if (on(polygon, plane)) continue;
      for (const std::vector<Index>& loop : polygon.loops) {
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
    all_.tree.query(boxAround(hull, all_.coincidence), [&](Index p) {
      const OccluderPolygon& polygon = all_.polygons[p];
      if (glm::dot(polygon.normal, plane.normal) < 0 && on(polygon, plane)) {
        covered += areaInside(all_, polygon, prism, 0);
      }
      return true;
    });
    return missing - covered <= all_.coincidence * hull.radius;
  }

  const OccluderPolygons& all_;
  Progress& progress_;
  std::map<OccluderEdge, std::vector<Index>> users_;
  OccluderRegions regions_;
  ConvexGroups groups_;
  std::set<std::vector<Index>> failed_;     ///< sets that make no solid
  std::set<std::pair<Index, bool>> tried_;  ///< large groups, and whether of convex polygons alone
  /// Polygons of sets that were grown carefully, of all polygons and of convex ones alone.
  std::array<std::vector<std::uint8_t>, 2> given_up_;
};

}  // namespace

std::vector<ConvexSolid> convexSolids(const OccluderPolygons& all, std::vector<std::uint8_t>& taken,
                                      Progress& progress) {
  return SolidSearch(all, progress).run(taken);
}

}  // namespace radiosity
