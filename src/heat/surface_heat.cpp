// Figures of surfaces from those of their patches.
#include <algorithm>
#include <cmath>
#include <limits>

#include "radiosity/heat.h"

namespace radiosity {

namespace {

/// Root mean square over patches, by area, of J in all bands.
double meanRadiosity(const HeatSolution& solution, const PatchMesh& mesh) {
  const auto bands = std::size_t(solution.bands);
  double squares = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double all = 0;
    for (std::size_t b = 0; b < bands; ++b) all += solution.radiosity[i * bands + b];
    squares += mesh.area[i] * all * all;
    area += mesh.area[i];
  }
  return area > 0 ? std::sqrt(squares / area) : 0;
}

void addPatch(const HeatSolution& solution, const PatchMesh& mesh, std::size_t i, SurfaceHeat& s) {
  const auto bands = std::size_t(solution.bands);
  const double area = mesh.area[i];
  s.area += area;
  for (std::size_t b = 0; b < bands; ++b) {
    s.radiosity += area * solution.radiosity[i * bands + b];
    s.irradiance += area * solution.irradiance[i * bands + b];
  }
  s.radiated += area * solution.net_flux[i];
  s.convected += area * solution.convection[i];
  s.temperature += area * solution.temperature[i];
  s.lowest = std::min(s.lowest, solution.temperature[i]);
  s.highest = std::max(s.highest, solution.temperature[i]);
}

}  // namespace

std::vector<SurfaceHeat> heatBySurface(const HeatSolution& solution, const PatchMesh& mesh,
                                       const FormFactors& factors) {
  std::vector<SurfaceHeat> out(mesh.surface_names.size());
  std::vector<double> error(out.size(), 0.0);
  for (std::size_t s = 0; s < out.size(); ++s) {
    out[s].name = mesh.surface_names[s];
    out[s].lowest = std::numeric_limits<double>::infinity();
    out[s].highest = -out[s].lowest;
  }
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    addPatch(solution, mesh, i, out[mesh.surface[i]]);
    if (!factors.error.empty()) {
      error[mesh.surface[i]] += mesh.area[i] * factors.error[mesh.unknownOf(i)];
    }
  }
  const double rms = meanRadiosity(solution, mesh);
  for (std::size_t s = 0; s < out.size(); ++s) {
    SurfaceHeat& surface = out[s];
    if (!(surface.area > 0)) {
      surface.temperature = surface.lowest = surface.highest =
          std::numeric_limits<double>::quiet_NaN();
      continue;
    }
    surface.temperature /= surface.area;
    surface.radiosity /= surface.area;
    surface.irradiance /= surface.area;
    surface.net_flux = surface.radiated / surface.area;
    if (std::isnan(surface.temperature)) surface.lowest = surface.highest = surface.temperature;
    if (!factors.error.empty()) surface.irradiance_error = error[s] / surface.area * rms;
  }
  return out;
}

}  // namespace radiosity
