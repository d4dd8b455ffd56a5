// Which axis-aligned boxes overlap.
#pragma once

#include <utility>
#include <vector>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {

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
