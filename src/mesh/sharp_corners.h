// How sharply edges leave their ends beside each other.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// For every edge (two vertices) the smallest sine of the angles at which other edges leave either
/// of its ends beside it; 1 where none does at less than a right angle. Edges have a length. Takes
/// about n log n, whatever the number of edges at a vertex.
std::vector<double> sharpestSines(const std::vector<Vec3>& vertices,
                                  const std::vector<std::array<Index, 2>>& edges);

}  // namespace radiosity
