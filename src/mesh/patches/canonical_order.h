// An order of patches that does not depend on their numbers.
#pragma once

#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Patches by surface name, index within the surface and side: sums in this order do not depend on
/// the numbers of patches. Patches of one surface are consecutive.
std::vector<Index> canonicalOrder(const PatchMesh& mesh);

}  // namespace radiosity
