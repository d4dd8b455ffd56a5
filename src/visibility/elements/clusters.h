// The quadtree over the elements of one facet.
#pragma once

#include <span>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "visibility/elements/elements.h"

namespace radiosity {

/// An element as the quadtree sees it: a box around it in the facet's frame.
struct FlatElement {
  Index item = 0;  ///< the caller's number
  Vec2 middle{0.0};
  Vec2 lower{0.0};
  Vec2 upper{0.0};
};

/// Sorts `elements` (not empty; of equal places the first given stays first) so that every cluster
/// is a range, and appends the clusters to `clusters`, children after parents and siblings side by
/// side; ranges count from `first`. Returns the root. Boxes of middles are halved in both
/// directions, or in one where they are more than twice as long as wide.
Index appendClusters(std::span<FlatElement> elements, const PlaneFrame& frame, Index first,
                     std::vector<Cluster>& clusters);

}  // namespace radiosity
