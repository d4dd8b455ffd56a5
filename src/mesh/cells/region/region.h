// Triangulates a planar region without changing its boundary, in the plane's own coordinates.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A region bounded by loops of short pieces, with constraint pieces inside. Points are distinct.
struct Region {
  std::vector<Vec2> points;                 ///< ends of all pieces
  std::vector<std::vector<Index>> loops;    ///< into points; the region lies on the left
  std::vector<std::array<Index, 2>> inner;  ///< pieces inside that triangles must respect
  Vec2 along{1.0, 0.0};                     ///< unit; the background grid follows it
  double size = 0;                          ///< wanted distance of points inside
  double longest = std::numeric_limits<double>::infinity();  ///< no new edge is longer
  double clearance = 0;  ///< new points keep farther than this from all pieces
  bool improve = true;   ///< whether points inside are added and moved to improve angles
};

/// A triangle (last entry kNone) or a convex quadrilateral, counter-clockwise.
using Cell = std::array<Index, 4>;

/// Cells over region.points followed by `interior`.
struct RegionMesh {
  std::vector<Vec2> interior;
  std::vector<Cell> cells;
};

/// The points inside the region of a square grid of about `region.size`; none is closer to a piece
/// than 0.6 of the spacing. Inside is decided by even-odd over the loops.
std::vector<Vec2> backgroundGrid(const Region& region);

/// Constrained Delaunay triangulation of the region's pieces and a background grid. If wanted, it
/// is improved by inner points and moves until all angles are at least 25 degrees, or as large as
/// the boundary allows; then pairs of triangles are joined. Pieces are never split. Empty if pieces
/// cross or loops touch.
std::optional<RegionMesh> meshRegion(const Region& region);

/// Joins pairs of triangles into convex quadrilaterals with angles within 45 degrees of a right
/// angle, the squarest first; never across a piece of the region. Remaining triangles stay.
std::vector<Cell> pairTriangles(const Region& region, const std::vector<Vec2>& interior,
                                const std::vector<std::array<Index, 3>>& triangles);

}  // namespace radiosity
