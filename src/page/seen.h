// The data with which a page finds light within unknowns that patches share.
#pragma once

#include "page/container.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

/// Adds seen_*: seenPatches(), with values of axes of items in 16 bits. All have length 0 if each
/// patch is an unknown. Throws Cancelled.
void addSeenPatches(const PatchMesh& mesh, Progress& progress, Container& container);

}  // namespace radiosity::page
