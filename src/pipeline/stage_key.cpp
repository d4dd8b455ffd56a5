#include "pipeline/stage_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <type_traits>

#include "base/hash.h"
#include "base/parse.h"
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

template <class Number>
void read(const StageKey& key, std::string_view name, Number& value) {
  const std::optional<std::string> text = key.get(name);
  if (!text) return;
  if constexpr (std::is_same_v<Number, bool>) {
    value = *text == "on";
  } else {
    Number parsed{};
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), parsed);
    if (error == std::errc() && end == text->data() + text->size()) value = parsed;
  }
}

std::string sourcesHash(std::span<const LightSource> sources) {
  Hash hash;
  for (const LightSource& source : sources) {
    hash.text(source.name);
    hash.array(source.emission);
    hash.array(source.sky);
  }
  return hash.hex();
}

/// Reads an option from a key; leaves `value` as it is if the key does not name it.
template <class Table, class Enum>
void readNamed(const StageKey& key, std::string_view name, const Table& table, Enum& value) {
  if (const auto found = named(table, key.get(name).value_or(""))) value = *found;
}

/// True for options that are in a key only if they differ from the default: the command line does
/// not have them, or did not always have them, and keys in older files must stay valid.
bool isNamedIfSet(std::string_view name) {
  return name == "random-turns" || name == "inset" || name == "eye";
}

/// The default tolerance of form factors that serve only as sources.
constexpr const char* kOfSources = "sources";

void addTurns(StageKey& key, bool random_turns) {
  if (!random_turns) key.add("random-turns", onOff(random_turns));
}

void addEye(StageKey& key, EyeChoice eye) {
  if (eye != EyeChoice::cpu) key.add("eye", nameOf(kEyeNames, eye));
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
  StageKey key;
  key.add("patches", fmt::format("{}", options.patches));
  key.add("max-edge", fmt::format("{}", options.max_edge));
  key.add("weld", fmt::format("{}", options.weld));
  key.add("faces-as-patches", onOff(options.faces_as_patches));
  key.add("scene", sceneHash(scene));
  return key;
}

namespace {

// The key has every option that the result may depend on, with its value as asked for: on another
// mesh `auto` may pick another method.
StageKey factorsKeyOf(const FormFactorOptions& options, const std::string& mesh_hash) {
  StageKey key;
  key.add("method", nameOf(kMethodNames, options.method));
  const MethodTraits& method = traitsOf(options.method);
  if (method.uses("tolerance")) {
    const char* unasked = options.sources_only ? kOfSources : "default";
    key.add("tolerance", options.tolerance ? fmt::format("{}", *options.tolerance) : unasked);
  }
  if (method.uses("closure")) key.add("closure", nameOf(kClosureNames, options.closure));
  if (method.uses("seed")) key.add("seed", fmt::format("{}", options.seed));
  if (method.uses("resolution")) key.add("resolution", fmt::format("{}", options.resolution));
  if (method.uses("symmetrize")) key.add("symmetrize", onOff(options.symmetrize));
  if (method.uses("near")) key.add("near", options.near_exact ? "exact" : "off");
  if (method.uses("random-turns")) addTurns(key, options.random_turns);
  if (method.uses("eye")) addEye(key, options.eye);
  if (!options.exact_emitters) key.add("emitters", "estimated");
  key.add("precision", nameOf(kPrecisionNames, options.storedPrecision()));
  key.add("mesh", mesh_hash);
  return key;
}

}  // namespace

StageKey factorsKey(const FormFactorOptions& options, const PatchMesh& mesh) {
  return factorsKeyOf(options, geometryHash(mesh));
}

StageKey usedKey(const StageKey& factors_key, std::string_view method) {
  FormFactorOptions options = factorOptionsOf(factors_key);
  options.method = named(kMethodNames, method).value_or(options.method);
  return factorsKeyOf(options, factors_key.get("mesh").value_or(""));
}

StageKey solutionKey(const SolveOptions& options, const PatchMaterials& materials,
                     const StageKey& factors_key) {
  StageKey key;
  key.add("solver", nameOf(kSolverNames, options.solver));
  key.add("solve-tolerance", fmt::format("{}", options.tolerance));
  key.add("max-iterations", fmt::format("{}", options.max_iterations));
  key.add("materials", materialsHash(materials));
  key.add("sky", skyText(materials.sky));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

StageKey basisKey(const SolveOptions& options, const PatchMaterials& materials,
                  std::span<const LightSource> sources, const StageKey& factors_key) {
  StageKey key;
  key.add("solver", nameOf(kSolverNames, options.solver));
  key.add("solve-tolerance", fmt::format("{}", options.tolerance));
  key.add("max-iterations", fmt::format("{}", options.max_iterations));
  key.add("reflectance", reflectanceHash(materials));
  key.add("sources", sourcesHash(sources));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

StageKey elementsKey(const ElementOptions& options, const std::string& solution_key) {
  StageKey key;
  key.add("element-tolerance", fmt::format("{}", options.tolerance));
  key.add("smallest-edge", fmt::format("{}", options.smallest_edge));
  key.add("most-vertices", fmt::format("{}", options.most_vertices));
  key.add("rays", fmt::format("{}", options.rays));
  key.add("most-rays", fmt::format("{}", options.most_rays));
  key.add("crease", fmt::format("{}", options.crease));
  key.add("seed", fmt::format("{}", options.seed));
  key.add("solution", keyHash(solution_key));
  return key;
}

StageKey gatherKey(const GatherOptions& options, const PatchMaterials& materials,
                   const PatchMesh& mesh) {
  StageKey key;
  key.add("at", nameOf(kGatherAtNames, options.at));
  key.add("passes", fmt::format("{}", options.passes));
  key.add("gather-tolerance", fmt::format("{}", options.tolerance));
  key.add("resolution", fmt::format("{}", options.resolution));
  key.add("seed", fmt::format("{}", options.seed));
  key.add("crease", fmt::format("{}", options.crease));
  addTurns(key, options.random_turns);
  addEye(key, options.eye);
  if (options.inset != GatherOptions().inset) key.add("inset", fmt::format("{}", options.inset));
  key.add("materials", materialsHash(materials));
  key.add("sky", skyText(materials.sky));
  key.add("mesh", geometryHash(mesh));
  return key;
}

namespace {

std::string listText(const std::vector<double>& values) {
  return values.empty() ? "none" : fmt::format("{}", fmt::join(values, ","));
}

void readList(const StageKey& key, std::string_view name, std::vector<double>& values) {
  const std::string text = key.get(name).value_or("none");
  for (const std::string_view word : splitAt(text, ',')) {
    if (const std::optional<double> value = parseNumber(word)) values.push_back(*value);
  }
}

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
  StageKey key;
  key.add("sky-temperature", fmt::format("{}", options.sky_temperature));
  key.add("band-edges", listText(options.bands.edges));
  key.add("band-fractions", listText(options.bands.fractions));
  key.add("heat-tolerance", fmt::format("{}", options.tolerance));
  key.add("heat-iterations", fmt::format("{}", options.max_iterations));
  if (options.sigma != kStefanBoltzmann) key.add("sigma", fmt::format("{}", options.sigma));
  key.add("conditions", conditionsHash(conditions));
  key.add("factors", keyHash(factors_key.text()));
  return key;
}

MeshOptions meshOptionsOf(const StageKey& key) {
  MeshOptions options;
  read(key, "patches", options.patches);
  read(key, "max-edge", options.max_edge);
  read(key, "weld", options.weld);
  read(key, "faces-as-patches", options.faces_as_patches);
  return options;
}

FormFactorOptions factorOptionsOf(const StageKey& key) {
  FormFactorOptions options;
  readNamed(key, "method", kMethodNames, options.method);
  double tolerance = 0;
  read(key, "tolerance", tolerance);
  if (tolerance > 0) options.tolerance = tolerance;
  options.sources_only = key.get("tolerance") == kOfSources;
  readNamed(key, "closure", kClosureNames, options.closure);
  options.near_exact = key.get("near") == "exact";
  options.exact_emitters = key.get("emitters") != "estimated";
  read(key, "resolution", options.resolution);
  read(key, "seed", options.seed);
  read(key, "symmetrize", options.symmetrize);
  read(key, "random-turns", options.random_turns);
  readNamed(key, "eye", kEyeNames, options.eye);
  options.precision = named(kPrecisionNames, key.get("precision").value_or(""));
  return options;
}

SolveOptions solveOptionsOf(const StageKey& key) {
  SolveOptions options;
  readNamed(key, "solver", kSolverNames, options.solver);
  read(key, "solve-tolerance", options.tolerance);
  read(key, "max-iterations", options.max_iterations);
  return options;
}

ElementOptions elementOptionsOf(const StageKey& key) {
  ElementOptions options;
  read(key, "element-tolerance", options.tolerance);
  read(key, "smallest-edge", options.smallest_edge);
  read(key, "most-vertices", options.most_vertices);
  read(key, "rays", options.rays);
  read(key, "most-rays", options.most_rays);
  read(key, "crease", options.crease);
  read(key, "seed", options.seed);
  return options;
}

GatherOptions gatherOptionsOf(const StageKey& key) {
  GatherOptions options;
  readNamed(key, "at", kGatherAtNames, options.at);
  read(key, "passes", options.passes);
  read(key, "gather-tolerance", options.tolerance);
  read(key, "resolution", options.resolution);
  read(key, "seed", options.seed);
  read(key, "crease", options.crease);
  read(key, "random-turns", options.random_turns);
  readNamed(key, "eye", kEyeNames, options.eye);
  read(key, "inset", options.inset);
  return options;
}

HeatOptions heatOptionsOf(const StageKey& key) {
  HeatOptions options;
  read(key, "sky-temperature", options.sky_temperature);
  readList(key, "band-edges", options.bands.edges);
  readList(key, "band-fractions", options.bands.fractions);
  read(key, "heat-tolerance", options.tolerance);
  read(key, "heat-iterations", options.max_iterations);
  read(key, "sigma", options.sigma);
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
