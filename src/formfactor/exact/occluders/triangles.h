// Triangles of a planar polygon with holes.
#pragma once

#include <array>
#include <vector>

#include "formfactor/exact/occluders/polygons.h"

namespace radiosity {

/// See trianglesOf().
inline constexpr std::size_t kMostBridged = 512;

/// Triangles over the polygon's own vertices that tile it, counter-clockwise about its normal.
/// Loops are joined by bridges between vertices that see each other, then ears are cut. Empty if
/// the loops cross, so that no such triangles exist, or have more than kMostBridged corners: that
/// takes time with the third power of their number.
std::vector<std::array<Index, 3>> trianglesOf(const OccluderPolygons& all,
                                              const OccluderPolygon& polygon);

}  // namespace radiosity
