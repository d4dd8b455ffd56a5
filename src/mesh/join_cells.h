// Cells of a polygon joined to patches of several.
#pragma once

#include <span>
#include <vector>

#include "mesh/polygon_cells.h"

namespace radiosity {

/// Joins cells across their edges, the smallest first and with the neighbour that makes the most
/// compact patch, to patches of up to size^2 whose corners lie no farther than `size` from their
/// centroid, and which are compact or more so than their parts. Edges in
/// `inner`, where something stands on the polygon, are kept, and so is the polygon's outline as it
/// is cut: what conforms goes on conforming. A patch is one loop around cells. `points`: of the
/// cells' corners. Returns the patches in the order of their first cells.
std::vector<CellGroup> joinCells(std::span<const Cell> cells,
                                 std::span<const std::array<Index, 2>> inner,
                                 std::span<const Vec3> points, double size);

}  // namespace radiosity
