// Gaps between edges of the same polygon.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The part of an edge that faces another edge across the inside of the polygon. Measured from the
/// edge's start, metres; the gap changes linearly from `from` to `to`.
struct Gap {
  double from = 0;
  double to = 0;
  double gap_from = 0;
  double gap_to = 0;
};

/// An edge of a polygon. The polygon is on its left or, for inner edges, on both sides.
struct PolygonEdge {
  std::array<Index, 2> ends;
  bool both_sides = false;
};

/// Calls found(k, gap) for every part of edge k that faces an edge without a common end at less
/// than `reach` and less than half of k's length. A third edge may lie between the two; it then has
/// a smaller gap. Neighbours are found by their boxes, not by trying all pairs.
void forGaps(const std::vector<Vec3>& vertices, const Vec3& normal,
             const std::vector<PolygonEdge>& edges, double reach,
             const std::function<void(std::size_t, const Gap&)>& found);

}  // namespace radiosity
