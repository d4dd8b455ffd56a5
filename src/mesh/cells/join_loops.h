// Joins two outlines that share edges.
#pragma once

#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The outline of the union of two regions of one plane, both given counter-clockwise by the
/// numbers of their vertices: all their edges except those that run both ways. It begins with its
/// lowest vertex. Empty if it is not a single loop that meets each vertex once. O(n log n).
std::vector<Index> joinLoops(const std::vector<Index>& a, const std::vector<Index>& b);

}  // namespace radiosity
