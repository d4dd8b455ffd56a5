#include "solve/cluster_solve.h"

#include <algorithm>

#include "formfactor/rays/patch_irradiance.h"
#include "mesh/cluster_means.h"
#include "solve/solve_rows.h"

namespace radiosity {
namespace {

bool anyAbove0(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return value > 0; });
}

}  // namespace

ClusterSolve::ClusterSolve(const FormFactors& factors, const PatchMaterials& materials,
                           const PatchMesh& mesh, const SolveOptions& options, Progress& progress)
    : factors_(factors),
      materials_(materials),
      mesh_(mesh),
      options_(options),
      progress_(progress),
      bands_(std::size_t(materials.bands)),
      sees_out_(anyAbove0(factors.sky) || anyAbove0(factors.backs)) {
  checkMaterials(materials.reflectance, materials.emission, materials.bands,
                 {mesh.surface, mesh.surface_names});
  reflectance_ = clusterMeans(mesh, materials.reflectance, materials.bands);
  emission_ = clusterMeans(mesh, materials.emission, materials.bands);
  surface_ = clusterSurfaces(mesh);
}

Solution ClusterSolve::run() const {
  Solution means = between({});
  if (means.irradiance.empty()) return means;  // singular
  PatchIrradiance within(mesh_, materials_.bands, materials_.sky);
  within.look(patchValues(mesh_, means.radiosity, materials_.bands), progress_);
  within.look(radiosityOf(within.around(means.irradiance)), progress_);
  const std::vector<double> more = balanced(within.beyondMeans(), means.irradiance);
  Solution solution = between(more);
  accountFor(more, solution.summary.energy);
  solution.summary.seconds += means.summary.seconds;
  solution.irradiance = within.around(solution.irradiance);
  solution.radiosity = radiosityOf(solution.irradiance);
  return solution;
}

Solution ClusterSolve::between(std::span<const double> more) const {
  return solveRows(factors_, reflectance_, emission_, materials_.bands, options_, progress_,
                   {surface_, mesh_.surface_names}, materials_.sky, more);
}

/// Of patches.
std::vector<double> ClusterSolve::radiosityOf(std::span<const double> irradiance) const {
  std::vector<double> radiosity = materials_.emission;
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    radiosity[k] += materials_.reflectance[k] * irradiance[k];
  }
  return radiosity;
}

/// Area times value, summed over clusters.
double ClusterSolve::power(std::span<const double> values, std::size_t band) const {
  const std::span<const double> area = factors_.matrix.area();
  double sum = 0;
  for (std::size_t c = 0; c < area.size(); ++c) sum += area[c] * values[c * bands_ + band];
  return sum;
}

/// `more` so that no irradiance falls below 0 by it, and that light is neither made nor lost where
/// all of it falls on fronts: then what differs within clusters falls elsewhere, all in all as
/// much.
std::vector<double> ClusterSolve::balanced(std::span<const double> more,
                                           std::span<const double> irradiance) const {
  std::vector<double> out(more.begin(), more.end());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], -irradiance[k]);
  for (std::size_t b = 0; !sees_out_ && b < bands_; ++b) {
    const double made = power(out, b);
    const double all = made + power(irradiance, b);
    if (!(all > 0)) continue;
    for (std::size_t k = b; k < out.size(); k += bands_) {
      out[k] -= made / all * (irradiance[k] + out[k]);
    }
  }
  return out;
}

/// What falls on fronts beyond what the matrix gives does not get out.
void ClusterSolve::accountFor(std::span<const double> more, EnergyAccount& account) const {
  for (std::size_t b = 0; sees_out_ && b < bands_; ++b) {
    account.to_sky[b] -= power(more, b);
    account.imbalance[b] += power(more, b);
  }
}

}  // namespace radiosity
