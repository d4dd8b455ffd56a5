#include "pipeline/stage_key.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/option_list.h"
#include "radiosity/names.h"
#include "radiosity/pipeline.h"

namespace radiosity {

namespace {

// The names whose values are hashes, and the words for a change of each.
constexpr std::pair<std::string_view, std::string_view> kIdentities[] = {
    {"scene", "geometry changed"},          {"mesh", "mesh changed"},
    {"materials", "materials changed"},     {"factors", "form factors changed"},
    {"solution", "solution changed"},       {"conditions", "conditions changed"},
    {"reflectance", "reflectance changed"}, {"sources", "sources changed"}};

std::string onOff(bool value) { return value ? "on" : "off"; }

std::string sourcesHash(std::span<const LightSource> sources) {
  Hash hash;
  for (const LightSource& source : sources) {
    hash.text(source.name);
    hash.array(source.emission);
    hash.array(source.sky);
  }
  return hash.hex();
}

template <class Options>
bool hasIfChanged(std::string_view name) {
  return std::ranges::any_of(optionLines(Options()), [&](const Option& option) {
    return option.line.in_key == InKey::if_changed && option.line.optionName() == name;
  });
}

/// True for options that a key lacks where they have their default.
bool isNamedIfSet(std::string_view name) {
  return hasIfChanged<FormFactorOptions>(name) || hasIfChanged<GatherOptions>(name) ||
         hasIfChanged<HeatOptions>(name);
}

std::string sceneHash(const Scene& scene) {
  Hash hash;
  hash.array(scene.vertices);
  hash.array(scene.face_offset);
  hash.array(scene.corners);
  hash.array(scene.face_surface);
  for (const Surface& surface : scene.surfaces) {
    hash.text(surface.name);
    const Material& material = scene.materials[surface.material];
    const bool emits = material.emission != Vec3(0.0);
    hash.text(onOff(material.two_sided) + onOff(emits));
  }
  return hash.hex();
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

/// One number if all bands have the same.
std::string skyText(const std::vector<double>& sky) {
  if (sky.empty()) return "0";
  const bool grey = std::all_of(sky.begin(), sky.end(), [&](double s) { return s == sky[0]; });
  return grey ? fmt::format("{}", sky[0]) : fmt::format("{}", fmt::join(sky, ","));
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

StageKey meshKey(const MeshOptions& options, const Scene& scene) {
  StageKey key(keyText(options));
  key.add("scene", sceneHash(scene));
  return key;
}

namespace {

// The key has every option that the result may depend on, with its value as asked for: on another
// mesh `auto` may pick another method.
StageKey factorsKeyOf(FormFactorOptions options, const std::string& mesh_hash) {
  options.precision = options.storedPrecision();
  StageKey key(keyText(options));
  key.add("mesh", mesh_hash);
  return key;
}

}  // namespace

StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh) {
  return factorsKeyOf(options, geometryHash(mesh));
}

StageKey usedKey(const StageKey& factors_key, std::string_view method) {
  auto options = optionsOf<FormFactorOptions>(factors_key);
  options.method = named(kMethodNames, method).value_or(options.method);
  return factorsKeyOf(options, factors_key.get("mesh").value_or(""));
}

StageKey solutionKey(const SolveOptions& options, const PatchMaterials& materials,
                     const StageKey& factors_key) {
  StageKey key(keyText(options));
  key.add("materials", materialsHash(materials));
  key.add("sky", skyText(materials.sky));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

StageKey basisKey(const SolveOptions& options, const PatchMaterials& materials,
                  std::span<const LightSource> sources, const StageKey& factors_key) {
  StageKey key(keyText(options));
  key.add("reflectance", reflectanceHash(materials));
  key.add("sources", sourcesHash(sources));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

StageKey elementsKey(const ElementOptions& options, const std::string& solution_key) {
  StageKey key(keyText(options));
  key.add("solution", keyHash(solution_key));
  return key;
}

StageKey gatherKey(const GatherOptions& options, const PatchMaterials& materials,
                   const PatchMesh& mesh) {
  StageKey key(keyText(options));
  key.add("materials", materialsHash(materials));
  key.add("sky", skyText(materials.sky));
  key.add("mesh", geometryHash(mesh));
  return key;
}

namespace {

/// Hashes a value such that a missing one differs from every number.
void addOptional(const std::optional<double>& value, Hash& hash) {
  hash.array(value ? std::vector<double>{*value} : std::vector<double>{});
}

std::string conditionsHash(const HeatConditions& conditions) {
  Hash hash;
  hash.array(conditions.of_surface);
  for (const std::string& group : conditions.text.groups) hash.text(group);
  for (const HeatCondition& c : conditions.conditions) {
    for (const Emissivity& e : c.emissivity) {
      hash.array(e.temperatures);
      hash.array(e.values);
    }
    addOptional(c.temperature, hash);
    addOptional(c.flux, hash);
    addOptional(c.power, hash);
    hash.array(std::vector<double>{c.convection, c.ambient});
    hash.text(onOff(c.isothermal));
  }
  return hash.hex();
}

}  // namespace

StageKey heatKey(const HeatOptions& options, const HeatConditions& conditions,
                 const StageKey& factors_key) {
  StageKey key(keyText(options));
  key.add("conditions", conditionsHash(conditions));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

template <>
FormFactorOptions optionsOf(const StageKey& key) {
  auto options = optionsIn<FormFactorOptions>(key.text());
  options.sources_only = key.get("tolerance") == "sources";
  return options;
}

std::string keyOfMesh(const MeshOptions& options, const Scene& scene) {
  return meshKey(options, scene).text();
}

std::string keyOfFactors(const FormFactorOptions& options, const PatchMesh& mesh) {
  return factorsKey(options, mesh).text();
}

std::string keyOfSolution(const SolveOptions& options, const PatchMaterials& materials,
                          const std::string& factors_key, const std::string& method) {
  return solutionKey(options, materials, usedKey(StageKey(factors_key), method)).text();
}

std::string keyOfHeat(const HeatOptions& options, const HeatConditions& conditions,
                      const std::string& factors_key, const std::string& method) {
  return heatKey(options, conditions, usedKey(StageKey(factors_key), method)).text();
}

}  // namespace radiosity
