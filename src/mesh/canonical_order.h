// An order of patches that does not depend on how they are numbered.
#pragma once

#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Patches by surface name, index within the surface and side: sums in this order do not depend on
/// how patches are numbered. Patches of one surface stand together.
std::vector<Index> canonicalOrder(const PatchMesh& mesh);

}  // namespace radiosity
