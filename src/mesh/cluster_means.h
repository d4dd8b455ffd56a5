// Values of clusters from those of their patches.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Means by area over each cluster of a mesh that has clusters; `values`: N * bands, row-major, a
/// row a patch; the result: K * bands, none of none. A mean lies within the values it is of.
std::vector<double> clusterMeans(const PatchMesh& mesh, std::span<const double> values, int bands);

/// Of each patch the value of its cluster: K * bands to N * bands.
std::vector<double> patchValues(const PatchMesh& mesh, std::span<const double> of_clusters,
                                int bands);

/// K, m^2: of the unknowns of any mesh, clusters or patches.
std::vector<double> unknownAreas(const PatchMesh& mesh);

/// The surface of each cluster.
std::vector<Index> clusterSurfaces(const PatchMesh& mesh);

}  // namespace radiosity
