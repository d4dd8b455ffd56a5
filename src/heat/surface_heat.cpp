// Computes the figures of surfaces from those of their patches.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "radiosity/heat.h"
#include "radiosity/surface_groups.h"

namespace radiosity {

namespace {

/// The parts of a solution: patches, or rows of a matrix.
struct Parts {
  std::span<const double> area;
  std::span<const Index> surface;  ///< into names
  std::vector<double> error;       ///< figures of their rows; empty: unknown
};

/// Root mean square over parts, by area, of J in all bands.
double meanRadiosity(const HeatSolution& solution, std::span<const double> areas) {
  const auto bands = std::size_t(solution.bands);
  double squares = 0;
  double area = 0;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    double all = 0;
    for (std::size_t b = 0; b < bands; ++b) all += solution.radiosity[i * bands + b];
    squares += areas[i] * all * all;
    area += areas[i];
  }
  return area > 0 ? std::sqrt(squares / area) : 0;
}

void addPart(const HeatSolution& solution, double area, std::size_t i, SurfaceHeat& s) {
  const auto bands = std::size_t(solution.bands);
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

std::vector<SurfaceHeat> summed(const HeatSolution& solution, const Parts& parts,
                                std::span<const std::string> names) {
  std::vector<SurfaceHeat> out(names.size());
  std::vector<double> error(out.size(), 0.0);
  for (std::size_t s = 0; s < out.size(); ++s) {
    out[s].name = names[s];
    out[s].lowest = std::numeric_limits<double>::infinity();
    out[s].highest = -out[s].lowest;
  }
  for (std::size_t i = 0; i < parts.area.size(); ++i) {
    if (!(parts.area[i] > 0)) continue;
    addPart(solution, parts.area[i], i, out[parts.surface[i]]);
    if (!parts.error.empty()) error[parts.surface[i]] += parts.area[i] * parts.error[i];
  }
  const double rms = meanRadiosity(solution, parts.area);
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
    if (std::isnan(surface.temperature)) {
      surface.lowest = surface.highest = surface.temperature;
    } else {  // a mean may be outside by rounding
      surface.temperature = std::clamp(surface.temperature, surface.lowest, surface.highest);
    }
    if (!parts.error.empty()) surface.irradiance_error = error[s] / surface.area * rms;
  }
  return out;
}

}  // namespace

std::vector<SurfaceHeat> heatBySurface(const HeatSolution& solution, const PatchMesh& mesh,
                                       const FormFactors& factors) {
  const SurfaceGroups groups = groupSurfaces(mesh.surface_names, solution.conditions.groups);
  std::vector<Index> group;
  group.reserve(mesh.size());
  for (const Index surface : mesh.surface) group.push_back(groups.of_surface[surface]);
  Parts parts{mesh.area, group, {}};
  for (std::size_t i = 0; i < mesh.size() && !factors.error.empty(); ++i) {
    parts.error.push_back(factors.error[i]);
  }
  return summed(solution, parts, groups.names);
}

std::vector<SurfaceHeat> heatByName(const HeatSolution& solution,
                                    std::span<const std::string> names,
                                    const FormFactors& factors) {
  const SurfaceGroups groups = groupSurfaces(names, solution.conditions.groups);
  std::vector<std::string> of_groups;
  std::vector<Index> group(names.size());
  std::unordered_map<std::string, Index> known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = groups.names[groups.of_surface[i]];
    const auto next = Index(of_groups.size());
    group[i] = name.empty() ? next : known.emplace(name, next).first->second;
    if (group[i] == next) of_groups.push_back(name.empty() ? fmt::format("row {}", i + 1) : name);
  }
  return summed(solution, {factors.matrix->area(), group, factors.error}, of_groups);
}

}  // namespace radiosity
