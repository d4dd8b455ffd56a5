// Light within clusters, where the solution has means of clusters alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/rays/ray_caster.h"
#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Looks from every cluster at its surroundings. Within a cluster irradiance is taken to be linear
/// in place and in the normal. The slopes are those of a least-squares fit to what rays from all
/// over the cluster find, shrunk by the share of them that noise explains (positive-part James and
/// Stein 1961). The same bits for any number of threads.
class PatchIrradiance {
 public:
  /// `mesh` is kept by reference; mesh.clusters is there. `sky`: radiance a band, or empty.
  PatchIrradiance(const PatchMesh& mesh, int bands, std::span<const double> sky);

  /// Looks at patches of this radiosity, N * bands, row-major, W/m^2. The first look traces rays
  /// and keeps what they end on, 4 bytes a ray, some 64 MiB; later ones look at the same patches.
  /// Throws Cancelled.
  void look(std::span<const double> radiosity, Progress& progress);

  /// N * bands, none below 0: the irradiance of patches whose clusters have `irradiance`, K *
  /// bands. The means of clusters stay what they are.
  std::vector<double> around(std::span<const double> irradiance) const;

  /// K * bands, W/m^2: what falls on each cluster from the patches that it sees, less what would
  /// fall on it if each of them had its cluster's mean radiosity. Matrices between clusters know
  /// means alone: light stays longer between patches that lie deep and bright ones lose more,
  /// though their cluster's mean is the same. Two means over the same rays: what both have in
  /// common, noise as well, cancels.
  const std::vector<double>& beyondMeans() const { return beyond_; }

 private:
  /// Place and normal.
  static constexpr int kFeatures = 6;
  struct Fit;
  struct View;

  std::size_t slopesOf(std::size_t cluster) const { return cluster * kFeatures * bands_; }
  void lookFrom(std::size_t cluster, const View& view);
  void addSlopes(std::size_t cluster, std::vector<double>& irradiance) const;

  const PatchMesh& mesh_;
  RayCaster caster_;
  std::size_t bands_;
  std::vector<double> sky_;  ///< pi times its radiance
  std::uint32_t rays_ = 0;
  std::vector<RayCaster::Ends> ends_;  ///< by cluster
  std::vector<double> slopes_;         ///< K * bands * kFeatures
  std::vector<double> beyond_;
};

}  // namespace radiosity
