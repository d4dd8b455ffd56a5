#include "radiosity/heat.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "heat/heat_solve.h"
#include "mesh/cluster_means.h"

namespace radiosity {

namespace {

/// Values of clusters as those of their patches.
std::vector<double> spread(const PatchMesh& mesh, const std::vector<double>& values, int bands) {
  return mesh.clusters ? patchValues(mesh, values, bands) : values;
}

/// The other side of each row: backs share unknowns as their fronts do.
std::vector<Index> twinsOf(const PatchMesh& mesh) {
  std::vector<Index> twin(mesh.unknowns(), kNone);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.twin[i] != kNone) twin[mesh.unknownOf(i)] = Index(mesh.unknownOf(mesh.twin[i]));
  }
  return twin;
}

}  // namespace

HeatSolution solveHeat(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                       Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  options.validate();
  HeatSolution solution = HeatSolve(factors, rows, options, progress).run();
  solution.summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return solution;
}

HeatSolution solveHeat(const FormFactors& factors, const HeatConditions& conditions,
                       const PatchMesh& mesh, const HeatOptions& options, Progress& progress) {
  if (conditions.of_surface.size() != mesh.surface_names.size()) {
    throw InputError(fmt::format("heat: {} surfaces have {} conditions", mesh.surface_names.size(),
                                 conditions.of_surface.size()));
  }
  std::vector<Index> of_row(mesh.unknowns());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    of_row[mesh.unknownOf(i)] = conditions.of_surface[mesh.surface[i]];
  }
  const std::vector<Index> twin = twinsOf(mesh);
  HeatSolution solution =
      solveHeat(factors, HeatRows{conditions.conditions, of_row, twin}, options, progress);
  for (std::vector<double>* banded : {&solution.radiosity, &solution.irradiance}) {
    *banded = spread(mesh, *banded, solution.bands);
  }
  for (std::vector<double>* one :
       {&solution.net_flux, &solution.convection, &solution.temperature}) {
    *one = spread(mesh, *one, 1);
  }
  return solution;
}

}  // namespace radiosity
