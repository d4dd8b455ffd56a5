// Two outlines that share edges made one.
#pragma once

#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The outline of two regions of one plane together, both given counter-clockwise by the numbers of
/// their vertices: their edges but for those that run both ways. It begins with its lowest vertex.
/// Empty if it is no single loop that meets each vertex once. n log n.
std::vector<Index> joinLoops(const std::vector<Index>& a, const std::vector<Index>& b);

}  // namespace radiosity
