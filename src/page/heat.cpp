#include "page/heat.h"

#include <cmath>

#include "page/header.h"

namespace radiosity::page {

namespace {

/// Sums over the bands, a value a patch.
std::vector<float> overBands(const std::vector<double>& values, int bands) {
  std::vector<float> sums(values.size() / std::size_t(bands), 0.0F);
  for (std::size_t k = 0; k < values.size(); ++k) sums[k / std::size_t(bands)] += float(values[k]);
  return sums;
}

/// Null if there is none: an undetermined temperature.
Container::Json known(double value) {
  return std::isfinite(value) ? Container::Json(value) : Container::Json();
}

}  // namespace

void addHeat(Pipeline& pipeline, Container& container) {
  const HeatSolution& heat = pipeline.heat();
  Container::Json surfaces = Container::Json::array();
  for (const SurfaceHeat& s : heatBySurface(heat, pipeline.mesh().mesh, pipeline.factors())) {
    surfaces.push_back({{"name", s.name},
                        {"area", s.area},
                        {"temperature", known(s.temperature)},
                        {"lowest", known(s.lowest)},
                        {"highest", known(s.highest)},
                        {"net_flux", s.net_flux},
                        {"radiated", s.radiated},
                        {"convected", s.convected}});
  }
  container.header()["heat"] = {{"message", heat.summary.message}, {"surfaces", surfaces}};
  container.add("heat_temperature", floats(heat.temperature));
  container.add("heat_net_flux", floats(heat.net_flux));
  container.add("heat_irradiance", overBands(heat.irradiance, heat.bands));
  container.add("heat_radiosity", overBands(heat.radiosity, heat.bands));
}

}  // namespace radiosity::page
