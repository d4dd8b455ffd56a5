// Lights that come from where nothing stands, together.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "radiosity/light.h"

namespace radiosity {

namespace {

Sunlight sunlightOf(std::span<const Light> lights, Up up) {
  Sunlight sunlight;
  for (const Light& light : lights) {
    const auto* sun = std::get_if<Sun>(&light.kind);
    if (sun == nullptr || !light.shines() || sun->toward == Vec3(0.0)) continue;
    const Vec3 toward = glm::normalize(sun->toward);
    const double sine = up == Up::z ? toward.z : toward.y;
    if (!(sine > 0)) continue;
    ++sunlight.suns;
    sunlight.toward = toward;
    sunlight.normal = light.strength;
    sunlight.horizontal.resize(light.strength.size(), 0.0);
    for (std::size_t b = 0; b < light.strength.size(); ++b) {
      sunlight.horizontal[b] += light.strength[b] * sine;
    }
  }
  return sunlight;
}

/// What its strength is times for an aimed light; of a sky, for its bright spots.
double aimedShare(const Light& light, std::size_t band) {
  return std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.ofSpots(band, band); }) {
          return of.ofSpots(band, light.strength.size());
        }
        return light.isAllRound() ? 0.0 : 1.0;
      },
      light.kind);
}

}  // namespace

std::vector<double> background(std::span<const Light> lights, int bands) {
  if (lights.empty()) return {};
  std::vector<double> radiance(std::size_t(bands), 0.0);
  for (const Light& light : lights) {
    for (std::size_t b = 0; b < radiance.size(); ++b) radiance[b] += light.radiance(b);
  }
  return radiance;
}

std::vector<Light> unevenSkies(std::span<const Light> lights) {
  std::vector<Light> skies;
  std::ranges::copy_if(lights, std::back_inserter(skies), [](const Light& light) {
    return light.shines() && light.isAllRound() && !light.isUniform();
  });
  return skies;
}

std::vector<Light> aimedLights(std::span<const Light> lights) {
  std::vector<Light> aimed;
  for (Light light : lights) {
    for (std::size_t b = 0; b < light.strength.size(); ++b) {
      light.strength[b] *= aimedShare(light, b);
    }
    if (light.shines()) aimed.push_back(std::move(light));
  }
  return aimed;
}

void settleSkies(std::span<Light> lights, Up up) {
  const Sunlight sunlight = sunlightOf(lights, up);
  for (Light& light : lights) {
    if (!light.shines()) continue;
    std::visit(
        [&](auto& of) {
          if constexpr (requires { of.settleSun(sunlight, light.strength); }) {
            of.settleSun(sunlight, light.strength);
          }
        },
        light.kind);
  }
}

Background::Background(std::span<const Light> lights, int bands, bool whole)
    : bands_(std::size_t(bands)) {
  const std::vector<double> uniform = background(lights, bands);
  if (std::ranges::any_of(uniform, [](double value) { return value > 0; })) uniform_ = uniform;
  for (const Light& sky : unevenSkies(lights)) domes_.push_back(sky.dome(whole));
}

void Background::add(const Vec3& toward, double times, std::span<double> sum) const {
  for (std::size_t b = 0; b < uniform_.size(); ++b) sum[b] += times * uniform_[b];
  for (const Dome& dome : domes_) dome(toward, times, sum);
}

}  // namespace radiosity
