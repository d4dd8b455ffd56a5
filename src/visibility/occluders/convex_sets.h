// Polygons in convex position, which are faces of convex solids.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "visibility/occluders/convex_groups.h"
#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"
#include "visibility/occluders/solids.h"

namespace radiosity {

/// Polygons in convex position: each lies behind the planes of all others.
struct ConvexSet {
  /// A polygon and the plane that it lies on, into `planes`.
  using Member = ConvexSolid::OnFace;
  std::vector<Member> members;  ///< by ascending polygon, once the set is grown
  std::vector<Index> vertices;
  std::vector<Occluder::Plane> planes;
  /// With Growth::known: planes by ConvexGroups::levelWith().
  std::map<Index, std::vector<Index>> faces_of_level;

  std::vector<Index> polygons() const;
};

/// The way a set is grown.
enum class Growth {
  greedy,
  careful,  ///< no neighbours in one plane, which may belong to bodies side by side, and none
            ///< with which the hull would not stay empty
  known,    ///< all candidates are known to be in convex position
};

/// True if a polygon may be a face of a solid; `convex_only`: of one with convex faces alone.
inline bool mayBeFace(const OccluderPolygon& polygon, bool convex_only) {
  return polygon.planar && polygon.one_sided && !polygon.faces_scene &&
         (polygon.convex || !convex_only);
}

/// Grows convex sets over common edges. It holds references to its arguments and changes nothing,
/// so that threads can share it.
class ConvexSetGrowth {
 public:
  ConvexSetGrowth(const OccluderPolygons& all, const OccluderEdgeUsers& users,
                  const ConvexGroups& groups)
      : all_(all), users_(users), groups_(groups) {}

  /// The set of one polygon and of neighbours, and theirs, of its group; `available(p)`: whether p
  /// may join.
  template <class Available>
  ConvexSet grow(Index seed, Growth way, const Available& available) const;

  std::optional<Occluder> hullOf(const ConvexSet& set) const;
  /// True if a polygon lies on a plane, whichever way it looks.
  bool isOn(const OccluderPolygon& polygon, const Occluder::Plane& plane) const;

 private:
  void join(ConvexSet& set, Index p, Growth way) const;
  void joinKnown(ConvexSet& set, Index p) const;
  bool add(ConvexSet& set, Index p) const;
  void append(ConvexSet& set, Index p, Index face) const;
  Index faceOf(const ConvexSet& set, const OccluderPolygon& polygon) const;
  bool staysEmpty(const ConvexSet& set) const;
  static void sortMembers(ConvexSet& set);
  /// Calls visit(p) for the polygons of a polygon's group that share an edge with it.
  template <class Visit>
  void forNeighbours(Index polygon, const Visit& visit) const;

  const OccluderPolygons& all_;
  const OccluderEdgeUsers& users_;
  const ConvexGroups& groups_;
};

template <class Visit>
void ConvexSetGrowth::forNeighbours(Index polygon, const Visit& visit) const {
  for (const std::vector<Index>& loop : all_.polygons[polygon].loops) {
    for (std::size_t c = 0; c < loop.size(); ++c) {
      const auto across = users_.find({loop[(c + 1) % loop.size()], loop[c]});
      if (across == users_.end()) continue;
      for (const Index p : across->second) {
        if (groups_.of(p) == groups_.of(polygon)) visit(p);
      }
    }
  }
}

template <class Available>
ConvexSet ConvexSetGrowth::grow(Index seed, Growth way, const Available& available) const {
  ConvexSet set;
  join(set, seed, way == Growth::known ? way : Growth::greedy);
  std::set<Index> met{seed};
  for (std::size_t k = 0; k < set.members.size(); ++k) {
    forNeighbours(set.members[k].polygon, [&](Index p) {
      if (available(p) && met.insert(p).second) join(set, p, way);
    });
  }
  sortMembers(set);
  return set;
}

}  // namespace radiosity
