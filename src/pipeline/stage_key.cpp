#include "pipeline/stage_key.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/option_list.h"
#include "radiosity/elements.h"
#include "radiosity/names.h"
#include "radiosity/solve.h"
#include "scene/lights/light_text.h"

namespace radiosity {

namespace {

// The names whose values are hashes, and the words for a change of each.
constexpr std::pair<std::string_view, std::string_view> kIdentities[] = {
    {"scene", "geometry changed"},          {"mesh", "mesh changed"},
    {"materials", "materials changed"},     {"factors", "form factors changed"},
    {"solution", "solution changed"},       {"conditions", "conditions changed"},
    {"reflectance", "reflectance changed"}, {"sources", "sources changed"}};

/// True for options of these structs that a key lacks where they have their default.
template <class... Options>
bool isNamedIfChanged(std::string_view name) {
  const auto named = [name](const Option& option) {
    return option.line.in_key == InKey::if_changed && option.line.optionName() == name;
  };
  return (std::ranges::any_of(optionLines(Options()), named) || ...);
}

/// The same for those of every stage.
bool isNamedIfSet(std::string_view name) {
  return isNamedIfChanged<MeshOptions, FormFactorOptions, SolveOptions, GatherOptions,
                          ElementOptions, HeatOptions>(name);
}

}  // namespace

/// Hashes each array as rows of all bands.
std::string materialsHash(const PatchMaterials& materials) {
  Hash hash;
  for (const std::vector<double>* values : {&materials.reflectance, &materials.emission}) {
    const std::uint64_t rows = values->size() / std::size_t(materials.bands);
    hash.bytes(&rows, sizeof rows);
    hash.bytes(values->data(), values->size() * sizeof(double));
  }
  return hash.hex();
}

std::string reflectanceHash(const PatchMaterials& materials) {
  Hash hash;
  hash.array(materials.reflectance);
  hash.text(fmt::format("{}", materials.bands));
  return hash.hex();
}

/// The sky's strength, then other lights; of many lights their hash.
std::string lightsText(std::span<const Light> lights) {
  constexpr std::size_t kLongest = 200;
  std::string others;
  for (const std::string& light : otherLights(lights)) others += ";" + light;
  if (others.size() > kLongest) {
    Hash hash;
    hash.text(others);
    others = ";" + hash.hex();
  }
  return strengthText(skyRadiance(lights)) + others;
}

std::string keyHash(const std::string& key) {
  Hash hash;
  hash.text(key);
  return hash.hex();
}

StageKey::StageKey(std::string_view text) {
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos) {
      add(std::string(pair.substr(0, equals)), std::string(pair.substr(equals + 1)));
    }
  }
}

void StageKey::add(std::string name, std::string value) {
  pairs_.emplace_back(std::move(name), std::move(value));
}

std::optional<std::string> StageKey::get(std::string_view name) const {
  for (const auto& [have, value] : pairs_) {
    if (have == name) return value;
  }
  return std::nullopt;
}

std::string StageKey::text() const {
  std::string text;
  for (const auto& [name, value] : pairs_) {
    if (!text.empty()) text += ' ';
    text.append(name).append("=").append(value);
  }
  return text;
}

std::string StageKey::difference(const StageKey& before, const StageKey& after) {
  std::string words;
  for (const auto& [name, value] : after.pairs_) {
    const std::optional<std::string> old = before.get(name);
    if (old == value) continue;
    std::string change = fmt::format(
        "{} {} -> {}", name, old.value_or(isNamedIfSet(name) ? "default" : "unknown"), value);
    for (const auto& [identity, phrase] : kIdentities) {
      if (name == identity) change = phrase;
    }
    words += (words.empty() ? "" : ", ") + change;
  }
  if (!words.empty()) return words;
  for (const auto& [name, value] : before.pairs_) {
    if (after.get(name)) continue;
    words += (words.empty() ? "" : ", ") + fmt::format("{} {} -> default", name, value);
  }
  return words;
}

}  // namespace radiosity
