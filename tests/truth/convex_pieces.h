// Planar polygons with holes as convex pieces.
#pragma once

#include <vector>

#include "loop.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::truth {

/// Convex loops that tile polygon p of the mesh, counter-clockwise about its normal: the polygon
/// itself where it is convex, else the triangles of a constrained Delaunay triangulation, joined
/// while they stay convex. `vertices` stand in for the mesh's. Corners in line with their
/// neighbours are left out. At most 12 corners a piece.
std::vector<Loop> convexPieces(const PlanarPolygons& polygons, std::size_t p,
                               const std::vector<Vec3>& vertices);

}  // namespace radiosity::truth
