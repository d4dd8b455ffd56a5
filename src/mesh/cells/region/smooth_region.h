// Moves points inside a region to improve the angles of its triangles.
#pragma once

#include "mesh/cells/region/triangulated_region.h"

namespace radiosity {

/// Moves vertices inside as long as that improves the smallest angles around them, in a few sweeps
/// at most. The triangulation is then not Delaunay: takePositions() and triangulate() make it so.
void smoothInside(TriangulatedRegion& region);

}  // namespace radiosity
