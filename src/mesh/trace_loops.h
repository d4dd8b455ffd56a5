// Loops of a polygon from its loose edges.
#pragma once

#include <array>
#include <vector>

#include "mesh/plane_image.h"
#include "mesh/welded_points.h"

namespace radiosity {

/// Puts directed edges, the inside on their left seen along `frame`, together into loops that
/// visit no vertex twice. Where several loops touch at a vertex they are kept apart, so that none
/// crosses another.
std::vector<std::vector<Index>> traceLoops(const WeldedPoints& points, const PlaneImage& frame,
                                           const std::vector<std::array<Index, 2>>& edges);

}  // namespace radiosity
