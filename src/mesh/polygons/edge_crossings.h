// Tests whether edges in a plane meet only at their ends.
#pragma once

#include <array>
#include <vector>

#include "mesh/plane_image.h"
#include "mesh/welded_points.h"

namespace radiosity {

/// Whether any two of `edges` cross, touch or overlap in the image of a plane other than at a
/// common end. Uses exact predicates; O(n log n) in the number of edges.
bool anyCross(const WeldedPoints& points, const PlaneImage& image,
              const std::vector<std::array<Index, 2>>& edges);

}  // namespace radiosity
