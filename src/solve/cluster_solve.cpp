#include "solve/cluster_solve.h"

#include "mesh/clusters/cluster_means.h"
#include "solve/beyond_means.h"
#include "solve/energy.h"
#include "solve/solve_rows.h"

namespace radiosity {

ClusterSolve::ClusterSolve(const FormFactors& factors, const PatchMaterials& materials,
                           const PatchMesh& mesh, const SolveOptions& options, Progress& progress)
    : factors_(factors),
      materials_(materials),
      mesh_(mesh),
      options_(options),
      progress_(progress),
      sees_out_(seesOut(factors)) {
  checkMaterials(materials.reflectance, materials.emission, materials.bands,
                 {mesh.surface, mesh.surface_names});
  reflectance_ = clusterMeans(mesh, materials.reflectance, materials.bands);
  emission_ = clusterMeans(mesh, materials.emission, materials.bands);
  LightOnPatches lights(mesh);
  by_lights_ = clusterMeans(mesh, lights.fromAround(materials.lights, factors.sky, materials.bands),
                            materials.bands);
  aimed_ = lights.aimed(materials.lights, materials.bands, progress);
  aimed_means_ = clusterMeans(mesh, aimed_.irradiance, materials.bands);
  for (std::size_t k = 0; k < by_lights_.size(); ++k) by_lights_[k] += aimed_means_[k];
  surface_ = clusterSurfaces(mesh);
}

Solution ClusterSolve::run() const {
  Solution means = between({});
  if (means.irradiance.empty()) return means;  // singular
  PatchIrradiance light(mesh_, materials_.bands, background(materials_.lights, materials_.bands));
  light.look(patchValues(mesh_, means.radiosity, materials_.bands), progress_);
  light.look(radiosityOf(within(light, means.irradiance)), progress_);
  std::vector<double> more =
      balanced(factors_, light.beyondMeans(), means.irradiance, materials_.bands);
  Solution solution = between(more);
  if (raiseToDark(more, solution.irradiance)) solution = between(more);
  accountFor(more, solution.summary.energy);
  noteErrorOf(aimed_, solution.summary);
  judgeBalance(factors_, emission_, solution.summary);
  solution.summary.seconds += means.summary.seconds;
  solution.irradiance = within(light, std::move(solution.irradiance));
  solution.radiosity = radiosityOf(solution.irradiance);
  return solution;
}

Solution ClusterSolve::between(std::span<const double> more) const {
  return solveRows(factors_, reflectance_, emission_, materials_.bands, options_, progress_,
                   {surface_, mesh_.surface_names}, by_lights_, more);
}

/// Of patches, from that of clusters. Rays tell how it varies, and lights that they do not bring.
std::vector<double> ClusterSolve::within(const PatchIrradiance& light,
                                         std::vector<double> irradiance) const {
  for (std::size_t k = 0; k < irradiance.size(); ++k) irradiance[k] -= aimed_means_[k];
  irradiance = light.around(irradiance);
  for (std::size_t k = 0; k < irradiance.size(); ++k) irradiance[k] += aimed_.irradiance[k];
  return irradiance;
}

/// Of patches.
std::vector<double> ClusterSolve::radiosityOf(std::span<const double> irradiance) const {
  std::vector<double> radiosity = materials_.emission;
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    radiosity[k] += materials_.reflectance[k] * irradiance[k];
  }
  return radiosity;
}

/// Corrects the account: light that reaches fronts in excess of the matrix does not reach the sky.
void ClusterSolve::accountFor(std::span<const double> more, EnergyAccount& account) const {
  for (int b = 0; sees_out_ && b < materials_.bands; ++b) {
    const double power = powerOf(factors_.matrix->area(), more, materials_.bands, b);
    account.to_sky[std::size_t(b)] -= power;
    account.imbalance[std::size_t(b)] += power;
  }
}

}  // namespace radiosity
