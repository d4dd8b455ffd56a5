// Chains of edges without their straight vertices.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/welded_points.h"

namespace radiosity {

/// By edge a list of numbers.
struct EdgeUses {
  std::vector<std::size_t> begin;  ///< edges + 1, into numbers
  std::vector<Index> numbers;

  std::span<const Index> of(std::size_t edge) const {
    return {numbers.data() + begin[edge], begin[edge + 1] - begin[edge]};
  }
};

struct StraightEdges {
  std::vector<std::array<Index, 2>> edges;  ///< the remaining edges
  std::vector<Index> edge_of;               ///< by given edge: the one it became a part of
  std::vector<bool> removed;                ///< by vertex
};

/// Removes vertices at which exactly two of `edges` meet in a straight line: all that is removed
/// between two neighbours that stay lies within coincidence of the line between them. Two edges
/// become one only where both have the same `uses`: they border or cut the same polygons. Vertices
/// marked in `keep` stay.
StraightEdges straighten(const WeldedPoints& points, double coincidence,
                         const std::vector<std::array<Index, 2>>& edges, const EdgeUses& uses,
                         const std::vector<bool>& keep);

}  // namespace radiosity
