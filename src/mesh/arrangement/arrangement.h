// The cells into which edges cut the planes.
#pragma once

#include <boost/container/small_vector.hpp>
#include <utility>
#include <vector>

#include "mesh/arrangement/split_edges.h"
#include "mesh/faces/sheets.h"

namespace radiosity {

/// A connected part of one plane that no edge divides and at least one sheet covers.
struct PlaneCell {
  Index plane = kNone;
  std::vector<std::pair<Index, int>> cover;  ///< sheets over it, ascending, with layers of each
  double area = 0;                           ///< m^2
  Vec3 sample{0.0};                          ///< a point well inside
  double room = 0;                           ///< about the metres from `sample` to the border
};

/// The cells on both sides of an edge in one plane, seen from a to b and from above the plane;
/// kNone for a side without a cell.
struct EdgeSides {
  Index plane = kNone;
  Index left = kNone;
  Index right = kNone;
};

struct Arrangement {
  std::vector<PlaneCell> cells;  ///< plane by plane
  /// By edge. Most edges have a plane on each side.
  std::vector<boost::container::small_vector<EdgeSides, 2>> sides;
  /// Sheets with a polygon that crosses itself, so that a part is turned over.
  std::vector<Index> inverted;
};

/// Two edges that cross in the image of a plane, and the point on the first.
struct ImageCrossing {
  Index first = kNone;
  Index second = kNone;
  Vec3 at{0.0};
};

/// The regions into which the edges in one plane cut it.
struct PlaneCut {
  bool done = false;  ///< if false, only `unresolved` and `crossings` are valid
  std::vector<PlaneCell> cells;
  /// Edges and the cells beside them, counted from the first of this plane.
  std::vector<std::pair<Index, EdgeSides>> sides;
  std::vector<Index> inverted;
  /// Vertices that fall on each other or on an edge in the image of the plane.
  Repairs unresolved;
  std::vector<ImageCrossing> crossings;
};

/// Cuts plane `number` along `own`, its edges. Needs edges that meet only at vertices.
PlaneCut cutPlane(const WeldedPoints& points, const std::vector<Plane>& planes, Index number,
                  const std::vector<Sheet>& sheets, const EdgeTable& edges,
                  const std::vector<Index>& own);

}  // namespace radiosity
