#include "radiosity/heat.h"

#include <fmt/format.h>

#include "base/processor_clock.h"
#include "heat/conditions.h"
#include "heat/heat_solve.h"

namespace radiosity {

namespace {

HeatSolution solved(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                    Progress& progress) {
  const Stopwatch watch;
  HeatSolution solution = HeatSolve(factors, rows, options, progress).run();
  solution.summary.seconds = watch.seconds();
  return solution;
}

}  // namespace

HeatSolution solveHeat(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                       Progress& progress) {
  options.validate();
  return solved(factors, rows, options, progress);
}

HeatSolution solveHeat(const FormFactors& factors, const HeatConditions& conditions,
                       const PatchMesh& mesh, const HeatOptions& options, Progress& progress) {
  options.validate();
  if (conditions.of_surface.size() != mesh.surface_names.size()) {
    throw InputError(fmt::format("heat: {} surfaces have {} conditions", mesh.surface_names.size(),
                                 conditions.of_surface.size()));
  }
  std::vector<Index> of_row(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    of_row[i] = conditions.of_surface[mesh.surface[i]];
  }
  const HeatRows rows{conditions.conditions, of_row, mesh.twin};
  HeatSolution solution = solved(factors, rows, options, progress);
  solution.conditions = conditions.text;
  return solution;
}

}  // namespace radiosity
