// Joins cells of a polygon to larger patches.
#pragma once

#include <span>
#include <vector>

#include "mesh/cells/polygon_cells.h"

namespace radiosity {

struct JoinLimits {
  double size = 0;      ///< metres, of patches; 0: only thin cells are joined with others
  double thinnest = 0;  ///< metres: cells lower than this over their longest edge are thin
};

/// Whether some cell is thin, as in JoinLimits.
bool anyThin(std::span<const Cell> cells, std::span<const Vec3> points, double thinnest);

/// Joins cells across their edges, the smallest first, with the neighbour that makes the most
/// compact patch. Patches have up to size^2 of area and corners within `size` of their centroid,
/// and are compact or more compact than their parts; a thin cell is joined whatever comes of it,
/// since nothing can be computed for it alone. Edges in `inner`, where other polygons stand,
/// are kept, and so is the cut outline of the polygon: the mesh stays conforming. A patch is one
/// loop around cells. `points`: the cells' corners. Returns the patches in the order of their first
/// cells.
std::vector<CellGroup> joinCells(std::span<const Cell> cells,
                                 std::span<const std::array<Index, 2>> inner,
                                 std::span<const Vec3> points, const JoinLimits& limits);

}  // namespace radiosity
