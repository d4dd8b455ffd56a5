// Every plane cut along the edges in it, edges being made to meet where that takes it.
#pragma once

#include <vector>

#include "mesh/arrangement.h"

namespace radiosity {

/// Splits and merges edges and vertices until edges meet only at vertices, in space and in the
/// image of every plane, and cuts the planes along them. Returns the planes for which that cannot
/// be had (details about as large as the coincidence may never come apart); if there are any,
/// `out` is not to be used. Planes are cut in parallel, and again only if their edges changed.
std::vector<Index> cutPlanes(InputFaces& input, const std::vector<Plane>& planes,
                             const std::vector<Sheet>& sheets, EdgeTable& edges, Arrangement& out,
                             Progress& progress);

}  // namespace radiosity
