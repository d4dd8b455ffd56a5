// The loops of polygons that are being built, without straight vertices and crossing edges.
#pragma once

#include "mesh/polygons/cell_drafts.h"
#include "mesh/polygons/straighten.h"

namespace radiosity {

/// Straightens the needed edges and traces the loops of all drafts. Straightening moves edges by up
/// to a coincidence, and other edges of a polygon may be hardly farther away. If a polygon's edges
/// then cross, its vertices are kept. With all vertices kept, the edges are those of the
/// arrangement, which do not cross except by rounding.
StraightEdges straightenDrafts(const CellsToMerge& cells, Drafts& drafts);

/// Whether the edges of a draft, inner ones included, do not cross.
bool isSound(const CellsToMerge& cells, const Drafts& drafts, const StraightEdges& straight,
             const Draft& draft);

}  // namespace radiosity
