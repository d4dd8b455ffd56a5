// Which black backs no patch can see, so that they need no elements.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// One flag a polygon of the mesh, 1: its back carries no patches and no patch can see it, because
/// a front covers it exactly, because all patches lie on its front side, or because it belongs to a
/// closed surface and every patch is on that surface's front side (Enclosures). 0 if none of this
/// is proved: such a back costs time, not accuracy.
std::vector<std::uint8_t> backsHiddenFromAll(const PatchMesh& mesh);

}  // namespace radiosity
