// Finds polygons that are quadrilaterals suited for a grid.
#pragma once

#include <optional>
#include <span>

#include "mesh/cells/edge_cuts.h"

namespace radiosity {

/// The four sides of a polygon of one loop: vertices in line with their neighbours
/// (closer than the coincidence) are no corners. Empty unless there are exactly four corners, all
/// angles within 30 and 150 degrees, opposite sides differing by at most a factor 1.5, and the
/// sides straight and their vertices dividing opposite sides in the same proportions. A bilinear
/// grid over such a quadrilateral has convex cells.
std::optional<FourSides> findFourSides(const CoarseComplex& complex, const CoarsePolygon& polygon,
                                       std::span<const DirectedEdge> edges);

}  // namespace radiosity
