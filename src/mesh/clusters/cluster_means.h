// Computes values of clusters from those of their patches, and back.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Means by area over each cluster of a mesh that has clusters. `values`: N * bands, row-major, one
/// row for each patch. The result has K * bands values, or none if `values` is empty. A mean lies
/// within the range of its values.
std::vector<double> clusterMeans(const PatchMesh& mesh, std::span<const double> values, int bands);

/// Gives each patch the values of its cluster: K * bands to N * bands.
std::vector<double> patchValues(const PatchMesh& mesh, std::span<const double> of_clusters,
                                int bands);

/// The areas, m^2, of the unknowns of any mesh: clusters or patches.
std::vector<double> unknownAreas(const PatchMesh& mesh);

/// The surface of each cluster.
std::vector<Index> clusterSurfaces(const PatchMesh& mesh);

}  // namespace radiosity
