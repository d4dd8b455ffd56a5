// What holds of lights of every kind.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "base/option_list.h"
#include "radiosity/light.h"
#include "radiosity/spelling.h"
#include "scene/lights/light_names.h"

namespace radiosity {

namespace {

/// The kinds that LightKind lists, with the parameters that they have by default.
template <std::size_t... K>
std::vector<Light> kindsOf(std::index_sequence<K...> /*all*/) {
  std::vector<Light> kinds;
  const auto add = [&kinds](const LightKind& kind) {
    Light& light = kinds.emplace_back("", kind, std::vector<double>());
    light.name = light.traits().word;
  };
  (add(std::variant_alternative_t<K, LightKind>()), ...);
  return kinds;
}

}  // namespace

const LightTraits& Light::traits() const {
  return std::visit([](const auto& of) -> const LightTraits& { return of.kTraits; }, kind);
}

bool Light::shines() const {
  return std::ranges::any_of(strength, [](double value) { return value > 0; });
}

bool Light::isUniform() const {
  return std::visit([](const auto& of) { return requires { of.radiance(1.0); }; }, kind);
}

bool Light::isAllRound() const {
  const auto isDome = [](const auto& of) {
    return requires { of.dome(std::span<const double>(), true); };
  };
  return isUniform() || std::visit(isDome, kind);
}

double Light::radiance(std::size_t band) const {
  return std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.radiance(1.0); }) return of.radiance(strength[band]);
        return 0.0;
      },
      kind);
}

double Light::fromAround(std::size_t band, double open) const {
  return std::numbers::pi * radiance(band) * open;
}

Dome Light::dome(bool whole) const {
  return std::visit(
      [&](const auto& of) -> Dome {
        if constexpr (requires { of.dome(strength, whole); }) return of.dome(strength, whole);
        return {};
      },
      kind);
}

std::optional<double> Light::overcast(std::size_t band) const {
  return std::visit(
      [&](const auto& of) -> std::optional<double> {
        if constexpr (requires { of.overcast(1.0); }) return of.overcast(strength[band]);
        return std::nullopt;
      },
      kind);
}

LightRay Light::ray(const Vec3& place, double u, double v) const {
  return std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.ray(place, u, v); }) return of.ray(place, u, v);
        return LightRay();
      },
      kind);
}

bool Light::isWide(const Vec3& place) const {
  return std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.isWide(place); }) return of.isWide(place);
        return false;
      },
      kind);
}

std::optional<double> Light::share(const Vec3& a, const Vec3& b, const Vec3& c) const {
  return std::visit(
      [&](const auto& of) -> std::optional<double> {
        if constexpr (requires { of.share(a, b, c); }) return of.share(a, b, c);
        return std::nullopt;
      },
      kind);
}

std::optional<double> Light::power(std::size_t band) const {
  return std::visit(
      [&](const auto& of) -> std::optional<double> {
        if constexpr (requires { of.power(); }) return strength[band] * of.power();
        return std::nullopt;
      },
      kind);
}

std::optional<Vec3> Light::place() const {
  return std::visit(
      [](const auto& of) -> std::optional<Vec3> {
        if constexpr (requires { of.at; }) return of.at;
        return std::nullopt;
      },
      kind);
}

std::string Light::fileName() const {
  return std::visit(
      [](const auto& of) -> std::string {
        if constexpr (requires { of.file; }) return of.file.name();
        return {};
      },
      kind);
}

std::vector<std::string> Light::remarks() const {
  return std::visit(
      [](const auto& of) -> std::vector<std::string> {
        if constexpr (requires { of.remarks(); }) return of.remarks();
        return {};
      },
      kind);
}

bool Light::isFromOutside() const { return isAllRound() || !place(); }

std::string Light::option() const {
  return traits().single ? spelled(traits().word) : spelled("light", traits().word);
}

void Light::settle(Up up) {
  std::visit(
      [up](auto& of) {
        if constexpr (requires { of.settle(up); }) of.settle(up);
      },
      kind);
}

void Light::validate() const {
  for (const double value : strength) {
    if (value >= 0 && std::isfinite(value)) continue;
    throw InputError(
        fmt::format("{} {} {} is not a finite value of 0 or more", name, traits().strength, value));
  }
  std::visit(
      [](const auto& of) {
        requireRanges(of);
        if constexpr (requires { of.validate(); }) of.validate();
      },
      kind);
}

Light uniformSky(std::vector<double> radiance) {
  return {UniformSky::kTraits.word, UniformSky(), std::move(radiance)};
}

std::vector<Light> lightKinds() {
  return kindsOf(std::make_index_sequence<std::variant_size_v<LightKind>>());
}

bool anyShines(std::span<const Light> lights) {
  return std::ranges::any_of(lights, &Light::shines);
}

bool anyShinesIn(std::span<const Light> lights) {
  return std::ranges::any_of(
      lights, [](const Light& light) { return light.isFromOutside() && light.shines(); });
}

std::string nextName(const std::string& word,
                     const std::function<bool(const std::string&)>& is_taken) {
  std::string name = word;
  for (int k = 2; is_taken(name); ++k) name = fmt::format("{} {}", word, k);
  return name;
}

bool isCalled(std::span<const Light> lights, const std::string& name) {
  return std::ranges::find(lights, name, &Light::name) != lights.end();
}

void setLight(std::vector<Light>& lights, Light light) {
  const auto same = std::ranges::find(lights, light.name, &Light::name);
  if (same == lights.end()) {
    lights.push_back(std::move(light));
  } else {
    *same = std::move(light);
  }
}

void addLight(std::vector<Light>& lights, Light light) {
  const std::string word = light.traits().word;
  if (!light.traits().single && light.name == word) {
    light.name = nextName(word, [&](const std::string& name) { return isCalled(lights, name); });
  } else if (!light.traits().single && isCalled(lights, light.name)) {
    throw InputError(fmt::format("light: two are called {}; give one another name", light.name));
  }
  setLight(lights, std::move(light));
}

}  // namespace radiosity
