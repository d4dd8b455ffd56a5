// Makes the arrays of a PatchMesh from cells of polygons.
#pragma once

#include <span>
#include <vector>

#include "mesh/cells/polygon_cells.h"

namespace radiosity {

/// Sets the mesh's coincidence if `least` is clearly less than the usual one.
void keepCoincidence(PatchMesh& mesh, double least);

/// The polygon whose cells polygon `p` uses: itself or, reversed, the polygon back to back with it,
/// so that both are cut alike.
inline std::size_t cellSource(const CoarseComplex& complex, std::size_t p) {
  const Index opposite = complex.polygons[p].opposite;
  return opposite != kNone && opposite < p ? opposite : p;
}

/// Makes all fronts polygon by polygon, then the backs. Areas are measured along the polygon's
/// normal, so that the patches of a polygon sum to its area although vertices are off the plane by
/// up to the coincidence. `cells`: those of every polygon that is its own cellSource().
PatchMesh assemblePatches(const CoarseComplex& complex, const Scene& scene, const EdgeCuts& cuts,
                          std::span<const PolygonCells> cells, Progress& progress);

/// Appends the back of every patch in `fronts`, in order: reversed, flipped, twins linked.
void appendBacks(PatchMesh& mesh, std::span<const Index> fronts);

/// Numbers patches and polygons within their surfaces, in order.
void numberWithinSurfaces(PatchMesh& mesh);

}  // namespace radiosity
