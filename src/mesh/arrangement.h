// The cells into which edges cut the planes.
#pragma once

#include <utility>
#include <vector>

#include "mesh/sheets.h"
#include "mesh/split_edges.h"

namespace radiosity {

/// A connected part of one plane that no edge divides and at least one sheet covers.
struct PlaneCell {
  Index plane = kNone;
  std::vector<std::pair<Index, int>> cover;  ///< sheets over it, ascending, and how many times
  double area = 0;                           ///< m^2
  Vec3 sample{0.0};                          ///< a point well inside
  double room = 0;                           ///< metres from `sample` to the cell's border, about
};

/// The cells on both sides of an edge in one plane, seen from a to b and from above the plane;
/// kNone where nothing covers it.
struct EdgeSides {
  Index plane = kNone;
  Index left = kNone;
  Index right = kNone;
};

struct Arrangement {
  std::vector<PlaneCell> cells;
  std::vector<std::vector<EdgeSides>> sides;  ///< by edge
  /// Where edges still meet without a vertex, and vertices that fall on each other in the image of
  /// a plane; if there are any, the rest is not to be used.
  Repairs unresolved;
  std::vector<Index>
      inverted;  ///< sheets with a polygon that crosses itself: a part is turned over
};

/// Cuts every plane along the edges in it. Needs edges that meet only at vertices; `points` gains
/// the crossings of edges that do not.
Arrangement arrange(WeldedPoints& points, const std::vector<Plane>& planes,
                    const std::vector<Sheet>& sheets, const EdgeTable& edges, Progress& progress);

}  // namespace radiosity
