#include "formfactor/cluster_factors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/made.h"
#include "mesh/clusters/cluster_means.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

double mostPatches(const PatchClusters& clusters) {
  std::size_t most = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    most = std::max(most, clusters.patchesOf(c).size());
  }
  return double(most);
}

}  // namespace

FormFactors clusterFactors(const FormFactors& factors, const PatchMesh& mesh, Progress& progress) {
  const PatchClusters& clusters = made(mesh.clusters);
  FormFactors result;
  const auto matrix = aggregated(*factors.matrix, clusters.of_patch, clusters.size(), progress);
  result.matrix = matrix;
  result.fronts = clusterMeans(mesh, factors.fronts, 1);
  result.backs = clusterMeans(mesh, factors.backs, 1);
  result.sky = clusterMeans(mesh, factors.sky, 1);
  result.backs_by_surface = factors.backs_by_surface;
  const double most = std::sqrt(mostPatches(clusters));
  result.error = clusterMeans(mesh, factors.error, 1);
  for (double& figure : result.error) figure *= most;
  result.method = factors.method;
  result.report = factors.report;
  const double squares = weightedSquares(*matrix);
  if (squares > 0) {
    result.report.error_figure *=
        most * std::sqrt(weightedSquares(pairsOf(*factors.matrix)) / squares);
  }
  return result;
}

std::size_t clusterMatrixBytes(const PatchMesh& mesh, bool symmetric, Precision precision) {
  const std::size_t k = mesh.unknowns();
  return symmetric ? estimateSymmetricBytes(k, double(k), precision)
                   : estimateRowFormBytes(k, double(k), precision);
}

std::size_t clusterFactorsBytes(const PatchMesh& mesh, bool symmetric, Precision precision,
                                std::size_t patch_bytes) {
  const std::size_t k = mesh.unknowns();
  // Exchange areas of the symmetric form are summed in 64 bits.
  const std::size_t sums = symmetric ? k * (k + 1) / 2 * sizeof(double) : 0;
  return sums + std::min(patch_bytes, clusterMatrixBytes(mesh, symmetric, precision));
}

}  // namespace radiosity
