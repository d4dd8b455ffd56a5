#include "heat/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/option_list.h"

namespace radiosity {

namespace {

/// The tolerance for the sum of the bands' shares, which should be 1: a few rounded decimals.
constexpr double kSharesTolerance = 1e-9;

void require(bool good, const std::string& name, const std::string& what) {
  if (!good) throw InputError(fmt::format("{}: {}", name, what));
}

bool isTemperature(double t) { return t >= 0 && t <= kHottest; }

bool isWithin(double value, double most) { return std::abs(value) <= most; }

void checkEmissivity(const std::string& name, const Emissivity& e) {
  const std::size_t wanted = e.temperatures.empty() ? 1 : e.temperatures.size();
  require(e.values.size() == wanted, name,
          fmt::format("emissivity has {} values for {} temperatures", e.values.size(),
                      e.temperatures.size()));
  for (const double value : e.values) {
    require(value >= 0 && value <= 1, name,
            fmt::format("emissivity {} is not within 0 and 1", value));
  }
  for (std::size_t k = 0; k < e.temperatures.size(); ++k) {
    require(isTemperature(e.temperatures[k]), name,
            fmt::format("emissivity at {} K: give temperatures in kelvin, 0 to {:g}",
                        e.temperatures[k], kHottest));
    require(k == 0 || e.temperatures[k] > e.temperatures[k - 1], name,
            "temperatures of the table of emissivity do not increase");
  }
}

void checkCondition(const HeatCondition& c, int bands) {
  require(c.emissivity.size() == 1 || c.emissivity.size() == std::size_t(bands), c.name,
          fmt::format("has {} emissivities for {} bands; give one, or one a band",
                      c.emissivity.size(), bands));
  for (const Emissivity& e : c.emissivity) checkEmissivity(c.name, e);
  const int given =
      int(c.temperature.has_value()) + int(c.flux.has_value()) + int(c.power.has_value());
  require(given <= 1, c.name, "has more than one of temperature, flux and power; give one");
  if (c.temperature) {
    require(
        isTemperature(*c.temperature), c.name,
        fmt::format("temperature {} is not one in kelvin, 0 to {:g}", *c.temperature, kHottest));
  }
  if (c.flux) {
    require(isWithin(*c.flux, kMostFlux), c.name,
            fmt::format("flux {} W/m^2 is not within {:g}", *c.flux, kMostFlux));
  }
  if (c.power) {
    require(isWithin(*c.power, kMostPower), c.name,
            fmt::format("power {} W is not within {:g}", *c.power, kMostPower));
  }
  require(
      c.convection >= 0 && c.convection <= kMostConvection, c.name,
      fmt::format("convection {} W/m^2/K is not within 0 and {:g}", c.convection, kMostConvection));
  require(isTemperature(c.ambient), c.name,
          fmt::format("ambient {} is not a temperature in kelvin, 0 to {:g}", c.ambient, kHottest));
}

}  // namespace

namespace {

/// The number of the first temperature of the table above `temperature`; none if it is beyond.
std::optional<std::size_t> firstAbove(const Emissivity& e, double temperature) {
  if (e.temperatures.empty() || temperature < e.temperatures.front()) return std::nullopt;
  const auto above = std::upper_bound(e.temperatures.begin(), e.temperatures.end(), temperature);
  if (above == e.temperatures.end()) return std::nullopt;
  return std::size_t(above - e.temperatures.begin());
}

}  // namespace

double Emissivity::at(double temperature) const {
  const std::optional<std::size_t> k = firstAbove(*this, temperature);
  if (!k) {
    const bool below = temperatures.empty() || temperature < temperatures.front();
    return below ? values.front() : values.back();
  }
  const double width = temperatures[*k] - temperatures[*k - 1];
  return std::lerp(values[*k - 1], values[*k], (temperature - temperatures[*k - 1]) / width);
}

double slopeOf(const Emissivity& e, double temperature) {
  const std::optional<std::size_t> k = firstAbove(e, temperature);
  if (!k) return 0;
  return (e.values[*k] - e.values[*k - 1]) / (e.temperatures[*k] - e.temperatures[*k - 1]);
}

int HeatBands::count() const {
  return fractions.empty() ? int(edges.size()) + 1 : int(fractions.size());
}

void HeatBands::validate() const {
  if (!edges.empty() && !fractions.empty()) {
    throw InputError("bands have edges and fractions; give one of them");
  }
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (!(edges[k] > 0) || !std::isfinite(edges[k]) || (k > 0 && !(edges[k] > edges[k - 1]))) {
      throw InputError(
          fmt::format("edge {} um of a band: give wavelengths above 0 that increase", edges[k]));
    }
  }
  for (const double fraction : fractions) {
    if (!(fraction >= 0 && fraction <= 1)) {
      throw InputError(fmt::format("fraction {} of a band is not within 0 and 1", fraction));
    }
  }
  const double sum = std::accumulate(fractions.begin(), fractions.end(), 0.0);
  if (!fractions.empty() && std::abs(sum - 1) > kSharesTolerance) {
    throw InputError(fmt::format("fractions of the bands sum to {}, not to 1", sum));
  }
}

void HeatOptions::validate() const {
  requireRanges(*this);
  bands.validate();
}

void validate(std::span<const HeatCondition> conditions, int bands) {
  for (const HeatCondition& condition : conditions) checkCondition(condition, bands);
}

void validate(const HeatConditions& conditions, const HeatOptions& options) {
  options.validate();
  validate(conditions.conditions, options.bands.count());
}

}  // namespace radiosity
