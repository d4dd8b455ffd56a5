#include "visibility/occluders/solids.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "visibility/occluders/clip.h"
#include "visibility/occluders/convex_groups.h"
#include "visibility/occluders/convex_sets.h"
#include "visibility/occluders/hull.h"
#include "visibility/occluders/regions.h"
#include "visibility/occluders/slabs.h"

namespace radiosity {
namespace {

using Flags = std::vector<std::uint8_t>;

/// Groups of polygons that a thread searches at a time.
constexpr std::size_t kGroupsAtOnce = 8;

/// The state of a group's polygons while it is searched. Flags go by the place in the group.
struct GroupMemory {
  explicit GroupMemory(std::size_t size) : taken(size, 0) {
    given_up.fill(Flags(size, 0));
    seen.fill(Flags(size, 0));
  }
  Flags taken;
  /// Polygons of sets that were grown carefully, of all polygons and of convex ones alone.
  std::array<Flags, 2> given_up;
  std::array<Flags, 2> seen;            ///< polygons that solids were made from, likewise
  std::array<bool, 2> tried{};          ///< a large group, likewise
  std::set<std::vector<Index>> failed;  ///< sets that make no solid
};

/// A solid that only the closed surface around it makes opaque.
struct Candidate {
  Index polygon;  ///< from which it was grown
  double score;   ///< goes down as others take its faces
  ConvexSolid solid;
};

/// Polygons in convex position are all of one group, so that groups are searched by themselves, in
/// parallel.
class SolidSearch {
 public:
  SolidSearch(const OccluderPolygons& all, Flags& taken, Progress& progress)
      : all_(all),
        taken_(taken),
        progress_(progress),
        users_(all.edgeUsers()),
        regions_(all, users_),
        groups_(all, users_, mayBeFaces()),
        growth_(all, users_, groups_),
        place_(all.polygons.size(), 0) {
    findMembers();
  }

  std::vector<ConvexSolid> run() {
    addPlain();
    addOpaque();
    return std::move(solids_);
  }

 private:
  Flags mayBeFaces() const {
    Flags out(all_.polygons.size());
    for (Index p = 0; p < out.size(); ++p) out[p] = mayJoin(p, false) ? 1 : 0;
    return out;
  }

  void findMembers() {
    std::vector<Index> number(all_.polygons.size(), kNone);
    for (Index p = 0; p < all_.polygons.size(); ++p) {
      if (!mayJoin(p, false)) continue;
      Index& g = number[groups_.of(p)];
      if (g == kNone) {
        g = Index(members_.size());
        members_.emplace_back();
      }
      place_[p] = Index(members_[g].size());
      members_[g].push_back(p);
    }
  }

  /// Runs search(g) for all groups, in parallel; returns the results in the groups' order.
  template <class Found, class Search>
  std::vector<Found> searchAll(const Search& search) {
    std::vector<Found> found(members_.size());
    parallelFor(members_.size(), kGroupsAtOnce, [&](std::size_t g) {
      if (!progress_.cancelled()) found[g] = search(members_[g]);
    });
    progress_.check();
    return found;
  }

  /// Adds bodies that stand for themselves, or on something.
  void addPlain() {
    using Found = std::vector<ConvexSolid>;
    const Flags before = taken_;
    std::vector<Found> found = searchAll<Found>([&](const auto& group) { return plain(group); });
    for (std::size_t g = 0; g < members_.size(); ++g) {
      // A solid of another group may lie on some of its polygons.
      const bool is_changed = std::any_of(members_[g].begin(), members_[g].end(),
                                          [&](Index p) { return taken_[p] != before[p]; });
      if (is_changed) found[g] = plain(members_[g]);
      for (ConvexSolid& solid : found[g]) {
        take(solid);
        solids_.push_back(std::move(solid));
      }
    }
  }

  std::vector<ConvexSolid> plain(const std::vector<Index>& group) const {
    std::vector<ConvexSolid> solids;
    GroupMemory memory(group.size());
    for (const bool convex_only : {true, false}) {
      // A search that failed with all of them would fail once more.
      if (!convex_only && solids.empty() && areConvex(group)) break;
      for (const Index seed : group) {
        if (isTaken(seed, memory) || !mayJoin(seed, convex_only)) continue;
        std::optional<ConvexSolid> solid = grownSolid(seed, convex_only, false, memory);
        if (!solid) continue;
        for (const ConvexSolid::OnFace& on : solid->on_faces) {
          if (isOf(group, on.polygon)) memory.taken[place_[on.polygon]] = 1;
        }
        solids.push_back(std::move(*solid));
      }
    }
    return solids;
  }

  /// Adds bodies that touch others on several sides, so that their faces are cut or merged with
  /// others', like boards and books. Of those that only the closed surface around them makes
  /// opaque, those with most volume times area of polygons on their faces come first.
  void addOpaque() {
    findOpaque();
    using Found = std::vector<Candidate>;
    std::vector<Candidate> candidates;
    for (Found& found : searchAll<Found>([&](const auto& group) { return opaque(group); })) {
      std::move(found.begin(), found.end(), std::back_inserter(candidates));
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& a, const Candidate& b) {
                       return a.score != b.score ? a.score > b.score : a.polygon < b.polygon;
                     });
    for (Candidate& candidate : candidates) {
      // Another candidate may have taken its faces by now.
      if (!(score(candidate.solid) > 0.5 * candidate.score)) continue;
      take(candidate.solid);
      solids_.push_back(std::move(candidate.solid));
    }
  }

  /// Finds opaque polygons one after the other: proofs have a common bound.
  void findOpaque() {
    opaque_.assign(all_.polygons.size(), 0);
    for (Index p = 0; p < all_.polygons.size(); ++p) {
      progress_.check();
      if (taken_[p] || !mayJoin(p, false) || isCurved(p)) continue;
      opaque_[p] = regions_.isBehindOpaque(p) ? 1 : 0;
    }
  }

  std::vector<Candidate> opaque(const std::vector<Index>& group) const {
    std::vector<Candidate> candidates;
    GroupMemory memory(group.size());
    const bool are_convex = areConvex(group);
    for (const Index p : group) {
      if (opaque_[p] == 0) continue;
      // The other faces of a body would give the same body once more; so would convex polygons
      // alone where there are no others.
      for (const bool convex_only : {false, true}) {
        if ((convex_only && are_convex) || !mayJoin(p, convex_only) ||
            memory.seen[convex_only][place_[p]] != 0) {
          continue;
        }
        if (std::optional<ConvexSolid> solid = grownSolid(p, convex_only, true, memory)) {
          candidates.push_back({p, score(*solid), std::move(*solid)});
        }
      }
      if (!mayJoin(p, true) || groups_.isLarge(p)) continue;
      std::optional<ConvexSolid> slab = slabSolid(p);
      // Alone on its slab the polygon blocks as well without it.
      if (slab && areaOnFaces(*slab) > all_.polygons[p].area) {
        candidates.push_back({p, score(*slab), std::move(*slab)});
      }
    }
    return candidates;
  }

  std::optional<ConvexSolid> slabSolid(Index p) const {
    std::optional<Occluder> body = slabBehind(all_, p);
    if (!body) return {};
    ConvexSolid slab{std::move(*body), {}};
    findOnFaces(slab, {});
    if (isLookedInto(slab, {})) return {};
    return slab;
  }

  /// `opaque`: a closed surface around the set may make it a solid.
  std::optional<ConvexSolid> grownSolid(Index seed, bool convex_only, bool opaque,
                                        GroupMemory& memory) const {
    if (isCurved(seed)) return {};
    const bool large = groups_.isLarge(seed);
    // The other polygons of a curved body would give the same body once more.
    if (large && std::exchange(memory.tried[convex_only], true)) return {};
    // Several bodies may be in convex position, side by side: then carefully one of them.
    const std::vector<Growth> ways = large ? std::vector<Growth>{Growth::known}
                                           : std::vector<Growth>{Growth::greedy, Growth::careful};
    for (const Growth way : ways) {
      Flags& given_up = memory.given_up[convex_only];
      if (way == Growth::careful && given_up[place_[seed]] != 0) continue;
      const ConvexSet set = growth_.grow(
          seed, way, [&](Index p) { return !isTaken(p, memory) && mayJoin(p, convex_only); });
      // The other polygons would give much the same once more, and each takes a hull for every
      // polygon that might join.
      if (way == Growth::careful) mark(set, given_up);
      std::vector<Index> key = set.polygons();
      if (!large && memory.failed.count(key) != 0) continue;
      std::optional<ConvexSolid> solid = solidOf(set, opaque);
      if (!solid) {
        if (!large) memory.failed.insert(std::move(key));
        continue;
      }
      mark(set, memory.seen[convex_only]);
      return solid;
    }
    return {};
  }

  void mark(const ConvexSet& set, Flags& flags) const {
    for (const ConvexSet::Member& m : set.members) flags[place_[m.polygon]] = 1;
  }

  bool mayJoin(Index p, bool convex_only) const { return mayBeFace(all_.polygons[p], convex_only); }

  /// True for a part of a curved surface that is no convex body as a whole.
  bool isCurved(Index p) const { return groups_.isLarge(p) && !groups_.isConvex(p); }

  bool areConvex(const std::vector<Index>& group) const {
    return std::all_of(group.begin(), group.end(), [&](Index p) { return mayJoin(p, true); });
  }

  bool isOf(const std::vector<Index>& group, Index p) const {
    return mayJoin(p, false) && groups_.of(p) == groups_.of(group.front());
  }

  /// True if a solid found before, or one of the group that is searched, has taken the polygon.
  bool isTaken(Index p, const GroupMemory& memory) const {
    return taken_[p] != 0 || memory.taken[place_[p]] != 0;
  }

  /// Marks the polygons that lie on faces of a solid.
  void take(const ConvexSolid& solid) {
    for (const ConvexSolid::OnFace& on : solid.on_faces) taken_[on.polygon] = 1;
  }

  std::optional<ConvexSolid> solidOf(const ConvexSet& set, bool opaque) const {
    if (set.planes.size() < 2) return {};
    std::optional<Occluder> hull = growth_.hullOf(set);
    // Polygons back to back make no solid: they are one flat occluder.
    if (!hull || hull->planes.size() < 4 || !isEmpty(all_, *hull, set.polygons())) return {};
    const std::vector<double> missing = missingAreas(*hull, set);
    if (!letsNothingIn(*hull, set, missing, opaque)) return {};
    ConvexSolid solid{std::move(*hull), {}};
    findOnFaces(solid, set.members);
    if (isLookedInto(solid, missing)) return {};
    return solid;
  }

  /// True if polygons on the body's faces look into it and see more there than backs: each other,
  /// or the outside of an open face. (A basin is often two sheets back to back; the outer one is in
  /// convex position. But a floor may look into the box that stands on it.)
  bool isLookedInto(const ConvexSolid& solid, const std::vector<double>& missing) const {
    std::set<Index> looking;
    for (const ConvexSolid::OnFace& on : solid.on_faces) {
      const OccluderPolygon& polygon = all_.polygons[on.polygon];
      const bool outward = glm::dot(polygon.normal, solid.body.planes[on.face].normal) > 0;
      if (!outward || !polygon.one_sided) looking.insert(on.face);
    }
    addOverlapping(solid, looking);
    if (looking.size() != 1) return !looking.empty();
    for (Index k = 0; k < missing.size(); ++k) {
      if (missing[k] > 0 && k != *looking.begin()) return true;
    }
    return false;
  }

  /// Adds the faces through which polygons look in that reach beyond them. (Two columns between a
  /// floor and a ceiling, whose parts within the columns see each other.)
  void addOverlapping(const ConvexSolid& solid, std::set<Index>& looking) const {
    const Occluder& body = solid.body;
    all_.tree.query(boxAround(body, all_.coincidence), [&](Index p) {
      const auto same = [](const ConvexSolid::OnFace& on) { return on.polygon; };
      if (std::ranges::binary_search(solid.on_faces, p, {}, same)) return true;
      const OccluderPolygon& polygon = all_.polygons[p];
      for (Index k = 0; k < body.planes.size(); ++k) {
        const bool outward = glm::dot(polygon.normal, body.planes[k].normal) > 0;
        if ((outward && polygon.one_sided) || !growth_.isOn(polygon, body.planes[k])) continue;
        Occluder prism = body;
        prism.planes.erase(prism.planes.begin() + k);
        if (areaInside(all_, polygon, prism, 0) > all_.coincidence * body.radius) looking.insert(k);
      }
      return true;
    });
  }

  /// Finds the polygons on the solid's faces. `members`: ascending; their faces are known.
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

  /// Area on the solid's faces of polygons not taken yet.
  double areaOnFaces(const ConvexSolid& solid) const {
    double area = 0;
    for (const ConvexSolid::OnFace& on : solid.on_faces) {
      if (!taken_[on.polygon]) area += all_.polygons[on.polygon].area;
    }
    return area;
  }

  double score(const ConvexSolid& solid) const { return areaOnFaces(solid) * volumeOf(solid.body); }

  /// True if nothing gets in or out where the set leaves the hull open.
  bool letsNothingIn(const Occluder& hull, const ConvexSet& set, const std::vector<double>& missing,
                     bool opaque) const {
    std::vector<Index> gaps;
    for (Index k = 0; k < hull.planes.size() && gaps.size() < 2; ++k) {
      const Occluder::Plane& plane = hull.planes[k];
      if (missing[k] > 0 && !all_.allBehind(plane.normal, plane.offset, all_.coincidence)) {
        gaps.push_back(k);
      }
    }
    if (gaps.empty()) return true;
    if (gaps.size() == 1 && isCovered(hull, set, gaps.front(), missing[gaps.front()])) return true;
    return opaque && opaque_[set.members.front().polygon] != 0;
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
      if (growth_.isOn(polygon, plane)) continue;
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
      if (glm::dot(polygon.normal, plane.normal) < 0 && growth_.isOn(polygon, plane)) {
        covered += areaInside(all_, polygon, prism, 0);
      }
      return true;
    });
    return missing - covered <= all_.coincidence * hull.radius;
  }

  const OccluderPolygons& all_;
  Flags& taken_;
  Progress& progress_;
  OccluderEdgeUsers users_;
  OccluderRegions regions_;
  ConvexGroups groups_;
  ConvexSetGrowth growth_;
  std::vector<std::vector<Index>> members_;  ///< of groups
  std::vector<Index> place_;                 ///< of polygons, in their groups
  Flags opaque_;                             ///< polygons that nobody can look behind
  std::vector<ConvexSolid> solids_;
};

}  // namespace

std::vector<ConvexSolid> convexSolids(const OccluderPolygons& all, std::vector<std::uint8_t>& taken,
                                      Progress& progress) {
  return SolidSearch(all, taken, progress).run();
}

}  // namespace radiosity
