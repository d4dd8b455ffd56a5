// Edges made to meet only at shared vertices.
#pragma once

#include <array>
#include <vector>

#include "mesh/sheets.h"

namespace radiosity {

/// A vertex an edge has to pass through.
struct ForcedSplit {
  Index edge = kNone;
  Index vertex = kNone;
};

/// The changes by which edges come to meet only at shared vertices.
struct Repairs {
  std::vector<ForcedSplit> splits;
  std::vector<std::array<Index, 2>> merges;  ///< vertices that are to become one

  bool empty() const { return splits.empty() && merges.empty(); }
};

/// Splits edges until no end of an edge lies inside another closer than coincidence, and no two
/// edges pass each other closer than that. Makes a point where two edges cross. `repairs` are made
/// first, whatever the distance; without any, all edges are looked at.
void splitEdges(WeldedPoints& points, double coincidence, EdgeTable& edges, const Repairs& repairs,
                Progress& progress);

}  // namespace radiosity
