// Loops of polygons in the making, without straight vertices and without edges that cross.
#pragma once

#include "mesh/cell_drafts.h"
#include "mesh/straighten.h"

namespace radiosity {

/// Straightens the edges that are needed and traces the loops of all drafts. Straightening moves
/// edges by up to a coincidence, and other edges of a polygon may be hardly farther away: where a
/// polygon's edges then cross, its vertices are kept. With all of them kept the edges are those of
/// the arrangement, which cross nowhere but for rounding.
StraightEdges straightenDrafts(const CellsToMerge& cells, Drafts& drafts);

/// Whether the edges of a draft, inner ones included, do not cross.
bool isSound(const CellsToMerge& cells, const Drafts& drafts, const StraightEdges& straight,
             const Draft& draft);

}  // namespace radiosity
