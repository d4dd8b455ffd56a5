// Moves of points inside a region that better the angles of its triangles.
#pragma once

#include "mesh/triangulated_region.h"

namespace radiosity {

/// Moves vertices inside while that betters the smallest angles around them, a few sweeps at most.
/// The triangulation is then no longer Delaunay's: takePositions() and triangulate() make it so.
void smoothInside(TriangulatedRegion& region);

}  // namespace radiosity
