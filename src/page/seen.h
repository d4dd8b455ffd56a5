// What a page needs to find light within unknowns that patches share.
#pragma once

#include "page/container.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

/// seen_*: seenPatches(), values of axes of items in 16 bits. All have length 0 where each patch is
/// an unknown. Throws Cancelled.
void addSeenPatches(const PatchMesh& mesh, Progress& progress, Container& container);

}  // namespace radiosity::page
