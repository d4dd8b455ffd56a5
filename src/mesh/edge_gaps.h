// How near other edges of the same polygon run to an edge.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A part of an edge that another edge of a polygon lies opposite of, across the inside. Measured
/// from the edge's start, metres; the gap changes linearly from `from` to `to`.
struct Gap {
  double from = 0;
  double to = 0;
  double gap_from = 0;
  double gap_to = 0;
};

/// An edge of a polygon, which lies on its left or, of inner edges, on both sides.
struct PolygonEdge {
  std::array<Index, 2> ends;
  bool both_sides = false;
};

/// Calls found(k, gap) for every part of every edge k that an edge without an end in common faces
/// from less than `reach` and half its own length away. A third edge may lie between the two; it
/// then has a smaller gap. Neighbours are found by a sweep over boxes, not by trying all pairs.
void forGaps(const std::vector<Vec3>& vertices, const Vec3& normal,
             const std::vector<PolygonEdge>& edges, double reach,
             const std::function<void(std::size_t, const Gap&)>& found);

}  // namespace radiosity
