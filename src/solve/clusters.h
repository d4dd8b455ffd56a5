// The system between clusters of patches, and back to patches.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Rows of `bands` values, one a patch, as means by area over each cluster of a mesh that has
/// clusters. A mean lies within the values it is of.
std::vector<double> clusterMeans(const PatchMesh& mesh, std::span<const double> values, int bands);

/// The surface of each cluster.
std::vector<Index> clusterSurfaces(const PatchMesh& mesh);

}  // namespace radiosity
