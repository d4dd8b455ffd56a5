// Cuts one planar polygon into cells.
#pragma once

#include <array>
#include <vector>

#include "mesh/cells/edge_cuts.h"
#include "mesh/cells/region/region.h"

namespace radiosity {

/// The cells of one patch.
struct CellGroup {
  std::vector<Index> outline;  ///< corners, counter-clockwise
  std::vector<Index> cells;    ///< ascending
  /// Triangles between corners of the outline that tile the patch; empty: the cells tile it.
  std::vector<std::array<Index, 3>> triangles;
};

/// Cells of one polygon, counter-clockwise about its normal. Corner c is boundary[c] (a point of
/// the EdgeCuts) below boundary.size(), else interior[c - boundary.size()].
struct PolygonCells {
  std::vector<Index> boundary;
  std::vector<Vec3> interior;
  std::vector<Cell> cells;
  std::vector<std::array<Index, 2>> inner;  ///< inner edges that all meshes have
  std::vector<CellGroup> groups;            ///< empty: each cell is a patch
  std::size_t patches() const { return groups.empty() ? cells.size() : groups.size(); }
};

/// The wanted size of cells.
struct CellSize {
  double size = 0;      ///< metres, of cells inside polygons
  double longest = 0;   ///< metres, of any new edge; infinite: no limit
  bool improve = true;  ///< whether points inside improve angles
};

/// A grid of convex quadrilaterals if the polygon has four sides with opposite ones cut alike; else
/// triangles and quadrilaterals over a background grid. The boundary is that of `cuts`. Empty if
/// its pieces cross, because edges are nearer to each other than rounding moves the points on them.
/// Edges that are kept whole never cross.
std::optional<PolygonCells> cellsOf(const CoarseComplex& complex, const EdgeCuts& cuts,
                                    std::size_t polygon, const CellSize& size);

}  // namespace radiosity
