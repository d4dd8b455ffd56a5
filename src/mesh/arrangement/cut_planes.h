// Cuts every plane along its edges, and makes edges meet where this needs it.
#pragma once

#include <vector>

#include "mesh/arrangement/arrangement.h"

namespace radiosity {

/// Splits and merges edges and vertices until edges meet only at vertices, in space and in the
/// image of every plane, and cuts the planes along them. Returns the planes for which this fails
/// (details about as large as the coincidence may never separate); if there are any, `out` must not
/// be used. Planes are cut in parallel, and again only if their edges changed.
std::vector<Index> cutPlanes(InputFaces& input, const std::vector<Plane>& planes,
                             const std::vector<Sheet>& sheets, EdgeTable& edges, Arrangement& out,
                             Progress& progress);

}  // namespace radiosity
