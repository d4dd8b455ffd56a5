// Light where patches share unknowns: between clusters, and within them.
#pragma once

#include <span>
#include <vector>

#include "radiosity/solve.h"

namespace radiosity {

/// First as if each cluster were of one radiosity. Rays then tell how irradiance differs within
/// clusters (PatchIrradiance), and what falls on each from its surroundings as they are in this
/// light beyond what the matrix gives, which knows means of clusters alone. With so much more or
/// less irradiance the matrix is solved again. At the end B = E + rho H of every patch, with an
/// irradiance of its own.
///
/// The means are not enough where patches lie deep and others open in one cluster: of books that
/// stand in a row, sides are 2.6% too bright after the first solution in data/furnished-room.obj
/// (2,000 clusters of 4,424 patches), and 0.9% after the second. *Test:* solve_clusters_test.
///
/// Of the summary, what is counted is of the second solution; seconds are of both.
class ClusterSolve {
 public:
  /// All are kept by reference; mesh.clusters is there.
  ClusterSolve(const FormFactors& factors, const PatchMaterials& materials, const PatchMesh& mesh,
               const SolveOptions& options, Progress& progress);
  Solution run() const;

 private:
  Solution between(std::span<const double> more) const;
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
  std::vector<Index> surface_;
};

}  // namespace radiosity
