// What holds of lights of every kind.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "base/option_list.h"
#include "radiosity/spelling.h"
#include "scene/lights/light_text.h"

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

/// Whether a parameter of the light has that name and can have that value, which it then has.
bool setParameter(Light& light, std::string_view name, std::string_view value) {
  bool set = false;
  const auto list = [&](const OptionLine& line, auto& field, const OptionRange& = {}) {
    if (line.optionName() == name) set = readOption(line, value, field);
  };
  std::visit([&](auto& kind) { kind.describe(list, kind); }, light.kind);
  return set;
}

[[noreturn]] void failAt(const Light& light, const std::string& text, int bands) {
  throw InputError(fmt::format(
      "{}: '{}' is not one finite number or {} with commas, {}{}", spelled(light.name), text,
      bands == 3 ? "three" : std::to_string(bands), light.traits().unit, light.parametersText()));
}

}  // namespace

const LightTraits& Light::traits() const {
  return std::visit([](const auto& of) -> const LightTraits& { return of.kTraits; }, kind);
}

std::string Light::parametersText() const {
  std::string text;
  const auto list = [&](const OptionLine& line, const auto& value, const OptionRange& = {}) {
    text += "," + line.optionName() + "=" + optionText(line, value);
  };
  std::visit([&](const auto& of) { of.describe(list, of); }, kind);
  return text;
}

bool Light::shines() const {
  return std::ranges::any_of(strength, [](double value) { return value > 0; });
}

bool Light::isAllRound() const {
  return std::visit([](const auto& of) { return requires { of.radiance(1.0); }; }, kind);
}

double Light::irradiance(std::size_t band, const LitPlace& place) const {
  return std::visit([&](const auto& of) { return of.irradiance(strength[band], place); }, kind);
}

double Light::radiance(std::size_t band) const {
  return std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.radiance(1.0); }) return of.radiance(strength[band]);
        return 0.0;
      },
      kind);
}

void Light::validate() const {
  for (const double value : strength) {
    if (value >= 0 && std::isfinite(value)) continue;
    throw InputError(
        fmt::format("{} {} {} is not a finite value of 0 or more", name, traits().strength, value));
  }
  std::visit([](const auto& of) { requireRanges(of); }, kind);
}

std::vector<Light> lightKinds() {
  return kindsOf(std::make_index_sequence<std::variant_size_v<LightKind>>());
}

Light lightOf(const std::string& word, const std::string& text, int bands) {
  std::vector<Light> kinds = lightKinds();
  const auto kind = std::ranges::find(kinds, word, &Light::name);
  if (kind == kinds.end()) {
    throw InputError(fmt::format("no light is called '{}'; there are {}", word,
                                 fmt::join(kinds | std::views::transform(&Light::name), ", ")));
  }
  Light light = std::move(*kind);
  for (const std::string_view part : splitAt(text, ',')) {
    const std::size_t equals = part.find('=');
    const std::optional<double> number = parseNumber(part);
    if (number) light.strength.push_back(*number);
    if (number || (equals != std::string_view::npos &&
                   setParameter(light, part.substr(0, equals), part.substr(equals + 1)))) {
      continue;
    }
    failAt(light, text, bands);
  }
  if (light.strength.size() == 1) light.strength.resize(std::size_t(bands), light.strength[0]);
  if (light.strength.size() != std::size_t(bands)) failAt(light, text, bands);
  return light;
}

std::vector<double> skyRadiance(std::span<const Light> lights) {
  const auto sky = std::ranges::find(lights, UniformSky::kTraits.word, &Light::name);
  return sky == lights.end() ? std::vector<double>() : sky->strength;
}

std::vector<std::string> otherLights(std::span<const Light> lights) {
  std::vector<std::string> texts;
  for (const Light& light : lights) {
    if (light.name == UniformSky::kTraits.word) continue;
    texts.push_back(light.name + "=" + strengthText(light.strength) + light.parametersText());
  }
  return texts;
}

std::vector<Light> lightsOf(const std::vector<double>& sky, std::span<const std::string> others,
                            int bands) {
  std::vector<Light> lights;
  if (!sky.empty()) lights.push_back(uniformSky(sky));
  for (const std::string& text : others) {
    const std::size_t equals = text.find('=');
    const bool whole = equals != std::string::npos;
    lights.push_back(lightOf(text.substr(0, equals), whole ? text.substr(equals + 1) : "", bands));
  }
  return lights;
}

std::string strengthText(std::span<const double> strength) {
  if (strength.empty()) return "0";
  const bool grey = std::ranges::all_of(strength, [&](double s) { return s == strength[0]; });
  return grey ? fmt::format("{}", strength[0]) : fmt::format("{}", fmt::join(strength, ","));
}

bool anyShines(std::span<const Light> lights) {
  return std::ranges::any_of(lights, &Light::shines);
}

std::vector<double> background(std::span<const Light> lights, int bands) {
  if (lights.empty()) return {};
  std::vector<double> radiance(std::size_t(bands), 0.0);
  for (const Light& light : lights) {
    for (std::size_t b = 0; b < radiance.size(); ++b) radiance[b] += light.radiance(b);
  }
  return radiance;
}

std::vector<Light> aimedLights(std::span<const Light> lights) {
  std::vector<Light> aimed;
  std::ranges::copy_if(lights, std::back_inserter(aimed),
                       [](const Light& light) { return light.shines() && !light.isAllRound(); });
  return aimed;
}

void setLight(std::vector<Light>& lights, Light light) {
  const auto same = std::ranges::find(lights, light.name, &Light::name);
  if (same == lights.end()) {
    lights.push_back(std::move(light));
  } else {
    *same = std::move(light);
  }
}

}  // namespace radiosity
