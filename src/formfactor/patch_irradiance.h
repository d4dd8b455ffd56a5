// Light within clusters, of which the solution has the means alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Looks from every cluster at its surroundings. Within a cluster irradiance is taken to be linear
/// in place and in the normal. Its slopes are fitted by least squares to the radiosity found by
/// rays from all over the cluster, then shrunk by the share of them that noise explains
/// (positive-part James and Stein 1961). The same bits for any number of threads.
class PatchIrradiance {
 public:
  /// `mesh` is kept by reference and has clusters. `sky`: radiance a band, or empty.
  PatchIrradiance(const PatchMesh& mesh, int bands, std::span<const double> sky);
  ~PatchIrradiance();

  /// Looks at patches of this radiosity, N * bands, row-major, W/m^2. The first look traces rays
  /// and keeps the items they end on, 4 bytes a ray, some 64 MiB, for later looks. Throws
  /// Cancelled.
  void look(std::span<const double> radiosity, Progress& progress);

  /// N * bands, none below 0: the irradiance of patches whose clusters have `irradiance`, K *
  /// bands. The means of clusters stay the same.
  std::vector<double> around(std::span<const double> irradiance) const;

  /// K * bands, W/m^2: the irradiance of each cluster from the patches that it sees, less its
  /// irradiance if each of them had its cluster's mean radiosity. Matrices between clusters know
  /// means alone, but light stays longer between patches that lie deep, and bright ones lose more,
  /// with the same mean of their cluster. Both terms are means over the same rays, so that their
  /// common part, noise included, cancels.
  const std::vector<double>& beyondMeans() const { return beyond_; }

 private:
  /// Place and normal.
  static constexpr int kFeatures = 6;
  struct Rays;
  struct Fit;
  struct View;

  std::size_t slopesOf(std::size_t cluster) const { return cluster * kFeatures * bands_; }
  void lookFrom(std::size_t cluster, const View& view);
  void addSlopes(std::size_t cluster, std::vector<double>& irradiance) const;

  const PatchMesh& mesh_;
  std::unique_ptr<Rays> rays_;
  std::size_t bands_;
  std::vector<double> sky_;     ///< pi times its radiance
  std::vector<double> slopes_;  ///< K * bands * kFeatures
  std::vector<double> beyond_;
};

}  // namespace radiosity
