// One planar polygon cut into cells.
#pragma once

#include <array>
#include <vector>

#include "mesh/edge_cuts.h"
#include "mesh/region.h"

namespace radiosity {

/// Cells that are one patch.
struct CellGroup {
  std::vector<Index> outline;  ///< corners, counter-clockwise
  std::vector<Index> cells;    ///< ascending
  /// Tile the patch between corners of the outline; empty: the cells tile it.
  std::vector<std::array<Index, 3>> triangles;
};

/// Cells of one polygon, counter-clockwise about its normal. Corner c is boundary[c] (a point of
/// the EdgeCuts) below boundary.size(), else interior[c - boundary.size()].
struct PolygonCells {
  std::vector<Index> boundary;
  std::vector<Vec3> interior;
  std::vector<Cell> cells;
  std::vector<std::array<Index, 2>> inner;  ///< edges inside that are there in all meshes
  std::vector<CellGroup> groups;            ///< empty: each cell is a patch
  std::size_t patches() const { return groups.empty() ? cells.size() : groups.size(); }
};

/// How large the cells are to be.
struct CellSize {
  double size = 0;     ///< metres, of cells inside polygons
  double longest = 0;  ///< metres, of any new edge; infinite: no limit
};

/// A grid of convex quadrilaterals where the polygon has four sides cut alike, triangles and
/// quadrilaterals over a background grid elsewhere. The boundary is taken as `cuts` has it. Empty
/// where its pieces cross: edges nearer to each other than rounding moves the points on them. Edges
/// that are kept whole never cross.
std::optional<PolygonCells> cellsOf(const CoarseComplex& complex, const EdgeCuts& cuts,
                                    std::size_t polygon, const CellSize& size);

}  // namespace radiosity
