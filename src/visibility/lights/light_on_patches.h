// What lights without a surface give to patches.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Irradiance of each patch by all lights together: N * bands, row-major, W/m^2, a mean over the
/// patch. `open`: by unknown, the share of what leaves it that meets nothing, of which an exact
/// row's account may be a little below 0; empty: without the lights that come from there. Errors:
/// InputError if shares are not those of the mesh.
std::vector<double> lightOnPatches(std::span<const Light> lights, const PatchMesh& mesh,
                                   std::span<const double> open, int bands);

}  // namespace radiosity
