// Finds axis-aligned boxes that overlap.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "base/geometry/box.h"
#include "radiosity/base.h"

namespace radiosity {

/// Whether a pair of boxes is wanted; called on all threads.
using PairFilter = std::function<bool(Index, Index)>;

/// Pairs (i, j), i < j, of boxes that overlap or touch, in ascending order; if `wanted` is given,
/// only the pairs for which it is true. Checks `progress`, if given, now and then for cancellation.
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const Progress* progress = nullptr,
                                                      const PairFilter& wanted = {});

/// Pairs of overlapping boxes with at least one from `some`. Ascending; each pair once, as
/// (smaller, larger).
std::vector<std::pair<Index, Index>> overlappingPairs(const std::vector<Box3>& boxes,
                                                      const std::vector<Index>& some,
                                                      const Progress* progress = nullptr,
                                                      const PairFilter& wanted = {});

}  // namespace radiosity
