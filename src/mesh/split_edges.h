// Edges made to meet only at shared vertices.
#pragma once

#include <vector>

#include "mesh/sheets.h"

namespace radiosity {

/// A vertex an edge has to pass through.
struct ForcedSplit {
  Index edge = kNone;
  Index vertex = kNone;
};

/// Splits edges until no end of an edge lies inside another closer than coincidence, and no two
/// edges pass each other closer than that. Makes a point where two edges cross. `forced` are
/// splits to make first, whatever the distance.
void splitEdges(WeldedPoints& points, double coincidence, EdgeTable& edges,
                const std::vector<ForcedSplit>& forced, Progress& progress);

}  // namespace radiosity
