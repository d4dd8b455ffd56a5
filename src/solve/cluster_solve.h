// The solution where patches share unknowns: between clusters, and within them.
#pragma once

#include <span>
#include <vector>

#include "formfactor/light_on_patches.h"
#include "formfactor/patch_irradiance.h"
#include "radiosity/solve.h"

namespace radiosity {

/// The first solution gives each cluster one radiosity. Rays then find how irradiance varies within
/// clusters (PatchIrradiance), and how much the irradiance of each cluster differs from that of the
/// matrix, which knows only means of clusters. The system is solved again with this difference as
/// additional irradiance. At the end B = E + rho H for every patch, with an irradiance of its own.
///
/// Means are not enough where one cluster has both hidden and open patches: in
/// data/furnished-room.obj (2,000 clusters of 4,424 patches), the sides of books in a row are 2.6%
/// too bright after the first solution, and 0.9% after the second. *Test:* solve_clusters_test.
///
/// The counts in the summary are those of the second solution; seconds are of both.
class ClusterSolve {
 public:
  /// Keeps all by reference. Precondition: the mesh has clusters.
  ClusterSolve(const FormFactors& factors, const PatchMaterials& materials, const PatchMesh& mesh,
               const SolveOptions& options, Progress& progress);
  Solution run() const;

 private:
  Solution between(std::span<const double> more) const;
  std::vector<double> within(const PatchIrradiance& light, std::vector<double> irradiance) const;
  std::vector<double> radiosityOf(std::span<const double> irradiance) const;
  void accountFor(std::span<const double> more, EnergyAccount& account) const;

  const FormFactors& factors_;
  const PatchMaterials& materials_;
  const PatchMesh& mesh_;
  const SolveOptions& options_;
  Progress& progress_;
  bool sees_out_;  ///< the sky or backs
  std::vector<double> reflectance_;
  std::vector<double> emission_;
  std::vector<double> by_lights_;  ///< K * bands: irradiance by lights without a surface
  LightFall aimed_;                ///< on patches: of these, by lights that rays do not bring
  std::vector<double> aimed_means_;
  std::vector<Index> surface_;
};

}  // namespace radiosity
