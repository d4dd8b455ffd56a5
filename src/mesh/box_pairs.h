// Which axis-aligned boxes overlap.
#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

struct Box3 {
  Vec3 low{std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity()};

  void add(const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
      if (p[k] < low[k]) low[k] = p[k];
      if (p[k] > high[k]) high[k] = p[k];
    }
  }
  Box3 grown(double by) const { return {low - Vec3(by), high + Vec3(by)}; }
  bool contains(const Vec3& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
  bool meets(const Box3& other) const {
    return low.x <= other.high.x && low.y <= other.high.y && low.z <= other.high.z &&
           high.x >= other.low.x && high.y >= other.low.y && high.z >= other.low.z;
  }
};

/// Pairs (i, j), i < j, of boxes that overlap or touch, in ascending order. `progress`, if given,
/// is asked now and then whether the run was cancelled.
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const Progress* progress = nullptr);

/// Pairs (i, j) of overlapping boxes with i from `some`; where both are in `some`, i < j.
/// Ascending; each pair once, as (smaller, larger).
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const std::vector<Index>& some,
                                                      const Progress* progress = nullptr);

}  // namespace radiosity
