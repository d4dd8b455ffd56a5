// The figures a report gives about a finished mesh.
#pragma once

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Fills polygons, triangles, quads, t_junctions, smallest angle and its surface, longest edge and
/// each surface's `kept` (surfaces without an entry get one). `coincidence` in metres.
void fillFigures(const PatchMesh& mesh, double coincidence, MeshReport& report);

}  // namespace radiosity
