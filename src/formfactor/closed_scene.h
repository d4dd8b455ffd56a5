// Whether any patch can see the sky.
#pragma once

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// True if no small hemicube (32 pixels) on any patch has a pixel of sky, for scenes that are not
/// proved closed (Enclosures::proved_closed). Stops at the first hemicube that has one. Throws
/// Cancelled.
bool closedByEye(const PatchMesh& mesh, Progress& progress);

}  // namespace radiosity
