// Polygons from drafts: numbers the vertices and finds the faces under the polygons.
#pragma once

#include "mesh/polygons/cell_drafts.h"
#include "mesh/polygons/straighten.h"

namespace radiosity {

/// Vertices and polygons, in an order that does not depend on the order of the file's faces.
CoarseComplex complexOf(const CellsToMerge& cells, const Drafts& drafts,
                        const StraightEdges& straight);

}  // namespace radiosity
