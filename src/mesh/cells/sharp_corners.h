// The angles between edges at their ends.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// For every edge (two vertices) the smallest sine of its angles to other edges at either end; 1 if
/// no angle is less than a right angle. Precondition: edges have a length. About O(n log n) for any
/// number of edges at a vertex.
std::vector<double> sharpestSines(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<Index, 2>>& edges);

}  // namespace radiosity
