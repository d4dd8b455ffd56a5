// The order of an unknown's patches along the first dimension of its rays' origins.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// `patches` in the order of a tree that halves their area again and again, each time across the
/// feature (place or normal) that spreads most; those without an area come last. Elementary
/// intervals of the first dimension of a net are then patches that lie near each other and face
/// alike, and so have much the same view: that is what nets gain by.
std::vector<Index> originOrder(const PatchMesh& mesh, std::span<const Index> patches);

}  // namespace radiosity
