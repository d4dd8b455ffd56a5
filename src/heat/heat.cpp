#include "radiosity/heat.h"

#include <fmt/format.h>

#include <numbers>

#include "base/processor_clock.h"
#include "formfactor/patch_irradiance.h"
#include "heat/conditions.h"
#include "heat/heat_solve.h"
#include "mesh/clusters/cluster_means.h"
#include "solve/beyond_means.h"

namespace radiosity {

namespace {

/// The other side of each row: backs share unknowns as their fronts do.
std::vector<Index> twinsOf(const PatchMesh& mesh) {
  std::vector<Index> twin(mesh.unknowns(), kNone);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.twin[i] != kNone) twin[mesh.unknownOf(i)] = Index(mesh.unknownOf(mesh.twin[i]));
  }
  return twin;
}

HeatSolution solved(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                    std::span<const double> more, Progress& progress) {
  const Stopwatch watch;
  HeatSolution solution = HeatSolve(factors, rows, options, more, progress).run();
  solution.summary.seconds = watch.seconds();
  return solution;
}

/// Solves heat if patches share unknowns, as ClusterSolve solves light. Rays find the irradiance
/// beyond the means of clusters; a second solution includes it. A cluster has one temperature;
/// irradiance, and so reflected radiation, differs within it.
class SharedHeat {
 public:
  /// All are kept by reference.
  SharedHeat(const FormFactors& factors, const HeatRows& rows, const PatchMesh& mesh,
             const HeatOptions& options, Progress& progress)
      : factors_(factors), rows_(rows), mesh_(mesh), options_(options), progress_(progress) {}

  HeatSolution run() const {
    const int bands = options_.bands.count();
    const HeatSolution means = solved(factors_, rows_, options_, {}, progress_);
    PatchIrradiance within(mesh_, bands, skyRadiance());
    within.look(patchValues(mesh_, means.radiosity, bands), progress_);
    within.look(ofPatches(means, within).radiosity, progress_);
    std::vector<double> more = balanced(factors_, within.beyondMeans(), means.irradiance, bands);
    HeatSolution second = solved(factors_, rows_, options_, more, progress_);
    if (raiseToDark(more, second.irradiance)) {
      second = solved(factors_, rows_, options_, more, progress_);
    }
    HeatSolution out = ofPatches(second, within);
    out.summary.seconds += means.summary.seconds;
    return out;
  }

 private:
  /// W/m^2/sr by band.
  std::vector<double> skyRadiance() const {
    const BlackBands black(options_);
    std::vector<double> radiance(std::size_t(black.count()));
    for (std::size_t b = 0; b < radiance.size(); ++b) {
      radiance[b] = black.total(options_.sky_temperature) *
                    black.fraction(int(b), options_.sky_temperature) / std::numbers::pi;
    }
    return radiance;
  }

  /// With the irradiance of each patch J = J of its cluster + (1 - eps) (H - H of its cluster).
  HeatSolution ofPatches(const HeatSolution& clusters, const PatchIrradiance& within) const {
    HeatSolution out;
    out.bands = clusters.bands;
    out.summary = clusters.summary;
    out.irradiance = within.around(clusters.irradiance);
    out.radiosity.resize(out.irradiance.size());
    out.net_flux.assign(mesh_.size(), 0.0);
    out.convection = patchValues(mesh_, clusters.convection, 1);
    out.temperature = patchValues(mesh_, clusters.temperature, 1);
    const auto bands = std::size_t(out.bands);
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      const std::size_t c = mesh_.unknownOf(i);
      const HeatCondition& condition = rows_.conditions[rows_.of_row[c]];
      for (std::size_t b = 0; b < bands; ++b) {
        const double reflected = 1 - emissivityIn(condition, b).at(out.temperature[i]);
        const double h = out.irradiance[i * bands + b];
        const double j = clusters.radiosity[c * bands + b] +
                         reflected * (h - clusters.irradiance[c * bands + b]);
        out.radiosity[i * bands + b] = j;
        out.net_flux[i] += j - h;
      }
    }
    return out;
  }

  const FormFactors& factors_;
  const HeatRows& rows_;
  const PatchMesh& mesh_;
  const HeatOptions& options_;
  Progress& progress_;
};

}  // namespace

HeatSolution solveHeat(const FormFactors& factors, const HeatRows& rows, const HeatOptions& options,
                       Progress& progress) {
  options.validate();
  return solved(factors, rows, options, {}, progress);
}

HeatSolution solveHeat(const FormFactors& factors, const HeatConditions& conditions,
                       const PatchMesh& mesh, const HeatOptions& options, Progress& progress) {
  options.validate();
  if (conditions.of_surface.size() != mesh.surface_names.size()) {
    throw InputError(fmt::format("heat: {} surfaces have {} conditions", mesh.surface_names.size(),
                                 conditions.of_surface.size()));
  }
  std::vector<Index> of_row(mesh.unknowns());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    of_row[mesh.unknownOf(i)] = conditions.of_surface[mesh.surface[i]];
  }
  const std::vector<Index> twin = twinsOf(mesh);
  const HeatRows rows{conditions.conditions, of_row, twin};
  HeatSolution solution = mesh.clusters ? SharedHeat(factors, rows, mesh, options, progress).run()
                                        : solved(factors, rows, options, {}, progress);
  solution.conditions = conditions.text;
  return solution;
}

}  // namespace radiosity
