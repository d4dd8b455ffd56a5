#include "mesh/clusters/cluster_means.h"

#include <algorithm>

#include "base/made.h"

namespace radiosity {

std::vector<double> clusterMeans(const PatchMesh& mesh, std::span<const double> values, int bands) {
  if (values.empty()) return {};
  const PatchClusters& clusters = made(mesh.clusters);
  const auto width = std::size_t(bands);
  std::vector<double> means(clusters.size() * width, 0.0);
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const std::span<const Index> patches = clusters.patchesOf(c);
    for (std::size_t b = 0; b < width; ++b) {
      double sum = 0;
      double area = 0;
      double low = values[patches[0] * width + b];
      double high = low;
      for (const Index i : patches) {
        const double value = values[i * width + b];
        sum += mesh.area[i] * value;
        area += mesh.area[i];
        low = std::min(low, value);
        high = std::max(high, value);
      }
      // Rounding must not make a reflectance larger than that of every patch.
      means[c * width + b] = area > 0 ? std::clamp(sum / area, low, high) : low;
    }
  }
  return means;
}

std::vector<double> patchValues(const PatchMesh& mesh, std::span<const double> of_clusters,
                                int bands) {
  const auto width = std::size_t(bands);
  std::vector<double> values(mesh.size() * width);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = of_clusters[mesh.unknownOf(k / width) * width + k % width];
  }
  return values;
}

std::vector<double> unknownAreas(const PatchMesh& mesh) {
  std::vector<double> area(mesh.unknowns(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) area[mesh.unknownOf(i)] += mesh.area[i];
  return area;
}

std::vector<Index> clusterSurfaces(const PatchMesh& mesh) {
  const PatchClusters& clusters = made(mesh.clusters);
  std::vector<Index> surfaces;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    surfaces.push_back(mesh.surface[clusters.patchesOf(c)[0]]);
  }
  return surfaces;
}

}  // namespace radiosity
