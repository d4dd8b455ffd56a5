// Which axis-aligned boxes overlap.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {

/// Whether a pair of boxes is wanted; asked on all threads.
using PairFilter = std::function<bool(Index, Index)>;

/// Pairs (i, j), i < j, of boxes that overlap or touch, in ascending order; those alone that
/// `wanted`, if given, says yes to. `progress`, if given, is asked now and then whether the run was
/// cancelled.
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const Progress* progress = nullptr,
                                                      const PairFilter& wanted = {});

/// Pairs (i, j) of overlapping boxes with i from `some`; where both are in `some`, i < j.
/// Ascending; each pair once, as (smaller, larger).
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const std::vector<Index>& some,
                                                      const Progress* progress = nullptr,
                                                      const PairFilter& wanted = {});

}  // namespace radiosity
