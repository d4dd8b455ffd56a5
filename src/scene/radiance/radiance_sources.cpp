#include "scene/radiance/radiance_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/spelling.h"

namespace radiosity {

namespace {

std::vector<double> bandsOf(const Vec3& value) { return {value.x, value.y, value.z}; }

}  // namespace

void RadianceSources::add(const RadiancePrimitive& source) {
  const Vec3 middle = source.three(0);
  const double angle = source.numbers[3];
  if (!(glm::length(middle) > 0)) reader_.fail(source, "has no direction; give one");
  if (!(angle >= 0 && angle <= 360)) {
    reader_.fail(source, fmt::format("an angle of {} degrees is not 0 to 360; correct it", angle));
  }
  const RadianceModifiers modifiers = modifiersOf(reader_, source);
  if (modifiers.material == nullptr) {
    reader_.fail(source, "has no material among its modifiers; give it one, e.g. glow");
  }
  if (!modifiers.emits()) {
    notes_.add("sources that give no light are left out", source.name);
    return;
  }
  const Vec3 radiance = modifiers.radiance();
  if (!isEmission(radiance)) {
    reader_.fail(*modifiers.material, "a radiance is a finite number of 0 or more; correct it");
  }
  if (modifiers.pattern != nullptr) {
    notes_.add(fmt::format("sources with a pattern are left out, they GIVE NO LIGHT ({} and {} "
                           "are skies)",
                           spelled("cie_sky"), spelled("perez_sky")),
               source.name, Severity::loud);
  } else if (angle == 360) {
    whole_ += radiance;
  } else if (angle == 180) {
    halves_.push_back({names_.make(source.name), glm::normalize(middle), radiance});
  } else if (angle <= 90) {
    addSun(source, radiance);
  } else {
    notes_.add(
        "sources of more than 90 degrees other than 180 and 360 are left out, they GIVE NO "
        "LIGHT",
        source.name, Severity::loud);
  }
}

/// What faces a disc of one radiance gets its projected solid angle, pi sin^2 of half the angle.
void RadianceSources::addSun(const RadiancePrimitive& source, const Vec3& radiance) {
  const double sine = std::sin(source.numbers[3] / 2 * std::numbers::pi / 180);
  Sun sun;
  sun.toward = glm::normalize(source.three(0));
  sun.diameter = source.numbers[3];
  suns_.push_back(
      {names_.make(source.name), sun, bandsOf(std::numbers::pi * sine * sine * radiance), false});
}

void RadianceSources::appendTo(std::vector<Light>& lights) const {
  constexpr double kOpposite = 1e-6;
  std::vector<Half> halves = halves_;
  Vec3 whole = whole_;
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const auto other =
        std::find_if(halves.begin() + std::ptrdiff_t(k) + 1, halves.end(), [&](const Half& half) {
          return half.radiance == halves[k].radiance &&
                 glm::length(half.middle + halves[k].middle) < kOpposite;
        });
    if (other != halves.end()) {
      whole += other->radiance;
      halves.erase(other);
      continue;
    }
    // A standard sky that is alike all over, about its own zenith.
    CieSky sky;
    sky.type = 5;
    sky.up = halves[k].middle;
    setLight(lights, {halves[k].name, sky, bandsOf(std::numbers::pi * halves[k].radiance), false});
  }
  if (whole != Vec3(0.0)) setLight(lights, uniformSky(bandsOf(whole)));
  for (const Light& sun : suns_) setLight(lights, sun);
}

}  // namespace radiosity
