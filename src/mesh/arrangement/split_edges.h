// Makes edges meet only at shared vertices.
#pragma once

#include <array>
#include <vector>

#include "mesh/faces/sheets.h"

namespace radiosity {

/// A vertex through which an edge must pass.
struct ForcedSplit {
  Index edge = kNone;
  Index vertex = kNone;
};

/// The changes that make edges meet only at shared vertices.
struct Repairs {
  std::vector<ForcedSplit> splits;
  std::vector<std::array<Index, 2>> merges;  ///< pairs of vertices to be merged

  bool empty() const { return splits.empty() && merges.empty(); }
};

/// Splits edges until no end of an edge lies inside another closer than coincidence, and no two
/// edges pass each other closer than that. Makes a point where two edges cross. `repairs` are
/// applied first, at any distance; without repairs, all edges are tested.
void splitEdges(WeldedPoints& points, EdgeTable& edges, const Repairs& repairs, Progress& progress);

}  // namespace radiosity
