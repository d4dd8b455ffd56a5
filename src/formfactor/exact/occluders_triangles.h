// Triangles of a planar polygon with holes.
#pragma once

#include <array>
#include <vector>

#include "formfactor/exact/occluders_polygons.h"

namespace radiosity {

/// Triangles over the polygon's own vertices that tile it, counter-clockwise about its normal.
/// Loops are joined by bridges between vertices that see each other, then ears are cut. Empty if
/// the loops cross, so that no such triangles exist.
std::vector<std::array<Index, 3>> trianglesOf(const OccluderPolygons& all,
                                              const OccluderPolygon& polygon);

}  // namespace radiosity
