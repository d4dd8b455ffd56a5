// Parts of surfaces without a reflex edge, over which convex solids can be grown.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "visibility/occluders/polygons.h"

namespace radiosity {

/// Polygons joined over edges across which each lies behind the other's plane. Polygons in convex
/// position that are joined by edges are all of one group. Linear in the polygons, but for their
/// edges' order, and n log n in those of large groups.
class ConvexGroups {
 public:
  /// Groups of more polygons than this are parts of curved surfaces. A search for the polygons of
  /// one that are in convex position takes time with the third power of its size, and a part of a
  /// curved surface hides little more than its faces do.
  static constexpr std::size_t kLarge = 64;

  /// `joins[p]`: 1 for polygons that may be faces of solids; others are left out.
  ConvexGroups(const OccluderPolygons& all, const OccluderEdgeUsers& users,
               const std::vector<std::uint8_t>& joins);

  Index of(Index polygon) const { return group_[polygon]; }
  /// The first of the polygons joined to this one over edges across which both lie on one plane.
  Index levelWith(Index polygon) const { return level_[polygon]; }
  bool isLarge(Index polygon) const { return size_[group_[polygon]] > kLarge; }
  /// For a polygon of a large group: true if each of the group lies behind all others' planes.
  bool isConvex(Index polygon) const { return convex_[group_[polygon]] != 0; }

 private:
  void testLarge(const OccluderPolygons& all);

  std::vector<Index> group_;  ///< of a polygon: the first of its group
  std::vector<Index> level_;
  std::vector<std::size_t> size_;
  std::vector<std::uint8_t> convex_;
};

}  // namespace radiosity
