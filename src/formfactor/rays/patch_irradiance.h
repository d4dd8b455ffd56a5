// The irradiance of each patch of a cluster, where the solution has the cluster's alone.
#pragma once

#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Within a cluster irradiance is taken to be linear in place and in the normal. The slopes are
/// those of a least-squares fit to what rays from all over the cluster find, shrunk by the share of
/// them that noise explains (positive-part James and Stein 1961); the cluster's mean stays what it
/// is. `radiosity`, `irradiance`: K * bands, row-major, of the clusters, W/m^2; `sky`: radiance a
/// band, or empty. Returns N * bands, none below 0. The same bits for any number of threads.
/// Precondition: mesh.clusters. Throws Cancelled.
std::vector<double> patchIrradiance(const PatchMesh& mesh, std::span<const double> radiosity,
                                    std::span<const double> irradiance, int bands,
                                    std::span<const double> sky, Progress& progress);

}  // namespace radiosity
