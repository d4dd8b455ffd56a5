// The roots of the trees of elements.
#pragma once

#include "radiosity/elements.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The roots over all patches that have an area and lie in a polygon.
ElementRoots elementRoots(const PatchMesh& mesh);

}  // namespace radiosity
