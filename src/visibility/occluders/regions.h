// The sides of closed surfaces that the fronts of polygons look into.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "base/geometry/box_tree.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

/// Polygons joined by edges. A set of one-sided polygons each of whose edges is run along as often
/// one way as the other is closed: the number of times it winds about a point changes only where
/// the surface is crossed, by one from the front of a polygon to its back.
///
/// PatchMesh::enclosures would not do: a surface is proved there if it neither touches nor crosses
/// itself, and each of its edges belongs to two polygons alone. Bodies that stand edge to edge, or
/// reach into each other, are closed for this purpose and not for that.
class OccluderRegions {
 public:
  OccluderRegions(const OccluderPolygons& all, const OccluderEdgeUsers& users);

  /// True if `polygon` belongs to a closed set of polygons and none of the scene's polygons looks
  /// into a region that this set winds about as often as about the points behind `polygon`. Then
  /// every way from a polygon's front to such a point crosses the surface. Proofs of one scene may
  /// take kMostSolidAngles; polygons that need more are not proved.
  bool isBehindOpaque(Index polygon);

 private:
  /// A second or less.
  static constexpr std::size_t kMostSolidAngles = 10000000;

  /// Twice the number of windings about an inner point of a polygon, its own part left out; nothing
  /// if that is no whole number: the point lies on another polygon.
  std::optional<int> doubledWinding(Index component, Index polygon);
  /// Finds the windings about the points in front of every member, and about all other components.
  void lookInto(Index component);
  bool lookFromMembers(Index component);
  bool lookFromOthers(Index component);

  const OccluderPolygons& all_;
  std::vector<Index> component_;
  std::vector<Index> side_class_;  ///< polygons with a common front region, by their edges
  std::vector<std::vector<Index>> members_;
  std::vector<std::uint8_t> closed_;
  std::vector<std::uint8_t> looked_into_;
  std::vector<std::set<int>> occupied_;  ///< of a component: windings of regions looked into
  std::map<Index, int> front_winding_;   ///< of a side class
  std::vector<Box3> bounds_;             ///< of components
  BoxTree first_members_;                ///< boxes of the components' first members
  std::size_t solid_angles_ = 0;
};

}  // namespace radiosity
