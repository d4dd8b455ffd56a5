// Makes the loops of a polygon from its edges.
#pragma once

#include <array>
#include <vector>

#include "mesh/plane_image.h"
#include "mesh/welded_points.h"

namespace radiosity {

/// Joins directed edges, with the inside on their left in the image `frame`, into loops that visit
/// no vertex twice. Loops that touch at a vertex are kept apart, so that none crosses another.
std::vector<std::vector<Index>> traceLoops(const WeldedPoints& points, const PlaneImage& frame,
                                           const std::vector<std::array<Index, 2>>& edges);

}  // namespace radiosity
