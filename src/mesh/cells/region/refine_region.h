// Inserts points inside a region that improve the angles of its triangles.
#pragma once

#include <cstddef>
#include <vector>

#include "mesh/cells/region/triangulated_region.h"

namespace radiosity {

/// Delaunay refinement without encroachment rules: candidate points are judged by the triangles
/// that they would make.
class RegionRefiner {
 public:
  /// Over all rounds it inserts hardly more points than there are now.
  explicit RegionRefiner(TriangulatedRegion& region)
      : region_(region), budget_(region.region().points.size() + region.interior().size() + 32) {}

  /// One round: inserts points until all triangles have the wanted angles, or no point helps.
  void refine();

 private:
  struct Trial {
    RegionFace where;    ///< the face that contains the point
    double gain = 0;     ///< the smallest angle around the point if it is worthwhile; else 0
    bool clear = false;  ///< removes the bad face and is outside the circles over constraints
  };
  Trial tryPoint(const RegionTriangulation::Point& p, RegionFace bad);
  bool improve(RegionFace bad, std::vector<RegionFace>& changed);

  TriangulatedRegion& region_;
  std::size_t inserted_ = 0;
  std::size_t budget_;
};

}  // namespace radiosity
