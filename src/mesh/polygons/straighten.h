// Removes straight vertices from chains of edges.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/welded_points.h"

namespace radiosity {

/// A list of numbers for each edge.
struct EdgeUses {
  std::vector<std::size_t> begin;  ///< edges + 1, into numbers
  std::vector<Index> numbers;

  std::span<const Index> of(std::size_t edge) const {
    return {numbers.data() + begin[edge], begin[edge + 1] - begin[edge]};
  }
};

struct StraightEdges {
  std::vector<std::array<Index, 2>> edges;  ///< the remaining edges
  std::vector<Index> edge_of;               ///< by given edge: the edge of which it is now a part
  std::vector<bool> removed;                ///< by vertex
};

/// Removes vertices at which exactly two of `edges` meet in a straight line: all vertices removed
/// between two neighbours that stay lie within coincidence of the line between them. Two edges
/// become one only if both have the same `uses`: they border or cut the same polygons. Vertices
/// marked in `keep` stay.
StraightEdges straighten(const WeldedPoints& points, const std::vector<std::array<Index, 2>>& edges,
                         const EdgeUses& uses, const std::vector<bool>& keep);

}  // namespace radiosity
