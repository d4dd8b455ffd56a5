// A quick test whether a box may meet one of a few others.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "mesh/box_pairs.h"

namespace radiosity {

/// Marks the cells of a coarse grid that the boxes touch. A box that touches no marked cell meets
/// none of the boxes.
class BoxFilter {
 public:
  explicit BoxFilter(const std::vector<Box3>& boxes);

  bool mayMeet(const Box3& box) const;

 private:
  /// Calls visit(key) for the cells that a box touches until it returns true. Returns true then,
  /// and also if there are too many cells.
  template <class Visit>
  bool forCells(const Box3& box, const Visit& visit) const;

  Box3 bounds_;
  Vec3 cells_per_metre_{0.0};
  bool all_ = false;  ///< a box is too large to be marked
  std::unordered_set<std::uint32_t> marked_;
};

}  // namespace radiosity
