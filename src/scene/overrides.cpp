// Changing materials by name, after reading.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

using Json = nlohmann::ordered_json;

/// Where an override came from and what it is called there: "--set lamp.emission=17".
struct Origin {
  std::string text;
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", text, what));
  }
};

std::vector<std::string> knownNames(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  const auto add = [&](const std::string& name) {
    if (seen.insert(name).second) names.push_back(name);
  };
  for (const Material& material : scene.materials) add(material.name);
  for (const Surface& surface : scene.surfaces) add(surface.object);
  for (const Surface& surface : scene.surfaces) add(surface.name);
  return names;
}

class Overrides {
 public:
  explicit Overrides(Scene& scene) : scene_(scene) {}

  /// Materials that `name` stands for, each used by nothing else: a surface that shares its
  /// material has been given its own copy.
  std::vector<Index> materialsOf(const std::string& name, const Origin& origin);
  void setProperty(const std::string& name, const std::string& property, const Vec3& value,
                   const Origin& origin);
  void setSides(const std::string& name, bool two_sided, const Origin& origin);
  void readMaterialsFile(const std::string& path);

 private:
  Index ownMaterial(Index surface, const std::vector<bool>& chosen);
  void note(std::string text) { scene_.notes.push_back({Severity::info, std::move(text)}); }
  void noteUnused(const std::string& name, Index material);

  Scene& scene_;
};

std::vector<Index> Overrides::materialsOf(const std::string& name, const Origin& origin) {
  const auto surfacesWhere = [&](const std::function<bool(const Surface&)>& test) {
    std::vector<bool> chosen(scene_.surfaces.size());
    for (std::size_t s = 0; s < chosen.size(); ++s) chosen[s] = test(scene_.surfaces[s]);
    return chosen;
  };
  const auto isSurface = [&](const Surface& surface) { return surface.name == name; };
  const auto isObject = [&](const Surface& surface) { return surface.object == name; };
  std::vector<Index> materials;
  std::vector<bool> chosen = surfacesWhere(isSurface);
  const bool any_surface = std::find(chosen.begin(), chosen.end(), true) != chosen.end();
  if (!any_surface) {
    for (std::size_t m = 0; m < scene_.materials.size(); ++m) {
      if (scene_.materials[m].name == name) materials.push_back(Index(m));
    }
    if (!materials.empty()) return materials;
    chosen = surfacesWhere(isObject);
  }
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    if (!chosen[s]) continue;
    const Index material = ownMaterial(Index(s), chosen);
    if (std::find(materials.begin(), materials.end(), material) == materials.end()) {
      materials.push_back(material);
    }
  }
  if (materials.empty()) {
    origin.fail(fmt::format("no surface, material or object is called {}; there are: {}", name,
                            joinNames(knownNames(scene_), 40)));
  }
  return materials;
}

Index Overrides::ownMaterial(Index surface, const std::vector<bool>& chosen) {
  const Index material = scene_.surfaces[surface].material;
  bool shared = false;
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    shared |= !chosen[s] && scene_.surfaces[s].material == material;
  }
  if (!shared) return material;
  const auto copy = Index(scene_.materials.size());
  scene_.materials.push_back(Material(scene_.materials[material]));
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    if (chosen[s] && scene_.surfaces[s].material == material) scene_.surfaces[s].material = copy;
  }
  return copy;
}

void Overrides::setProperty(const std::string& name, const std::string& property, const Vec3& value,
                            const Origin& origin) {
  const bool reflectance = property == "reflectance";
  if (!reflectance && property != "emission" && property != "radiance") {
    origin.fail(fmt::format("`{}` is none of reflectance, emission, radiance", property));
  }
  const Vec3 exitance = property == "radiance" ? std::numbers::pi * value : value;
  if (reflectance) {
    checkReflectance(origin.text, name, value);
  } else {
    checkEmission(origin.text, name, exitance);
  }
  std::set<std::string> said;
  for (const Index m : materialsOf(name, origin)) {
    Material& material = scene_.materials[m];
    Vec3& target = reflectance ? material.reflectance : material.emission;
    const std::string before =
        describeBands(target) + (reflectance && material.texture != kNone ? " x texture" : "");
    target = reflectance ? value : exitance;
    // A value that was asked for is the value, not one more factor.
    if (reflectance) material.texture = kNone;
    const std::string change =
        fmt::format("{}: {} {} -> {}{}", name, reflectance ? "reflectance" : "emission", before,
                    describeBands(target), reflectance ? "" : " W/m^2");
    if (said.insert(change).second) note(change);
    noteUnused(name, m);
  }
}

void Overrides::noteUnused(const std::string& name, Index material) {
  const bool used =
      std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(),
                  [&](const Surface& surface) { return surface.material == material; });
  if (used) return;
  const bool same_name_used =
      std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), [&](const Surface& surface) {
        return scene_.materials[surface.material].name == scene_.materials[material].name;
      });
  if (same_name_used) return;
  scene_.notes.push_back(
      {Severity::warning,
       fmt::format("{}: no face has this material; the change shows nowhere", name)});
}

void Overrides::setSides(const std::string& name, bool two_sided, const Origin& origin) {
  std::size_t changed = 0;
  const auto set = [&](Material& material) {
    changed += material.two_sided != two_sided ? 1 : 0;
    material.two_sided = two_sided;
  };
  if (name == "all") {
    for (Material& material : scene_.materials) set(material);
  } else {
    for (const Index m : materialsOf(name, origin)) set(scene_.materials[m]);
  }
  note(fmt::format("{}: {}-sided{}", name, two_sided ? "two" : "one",
                   changed == 0 ? ", as it was" : ""));
}

Vec3 bandsOf(const Json& value, const Origin& origin) {
  if (value.is_number()) return Vec3(value.get<double>());
  const bool triple =
      value.is_array() && value.size() == 3 &&
      std::all_of(value.begin(), value.end(), [](const Json& band) { return band.is_number(); });
  if (!triple) origin.fail("give one number or three in brackets: [0.6, 0.1, 0.1]");
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

void Overrides::readMaterialsFile(const std::string& path) {
  Json file;
  try {
    file = Json::parse(readWholeFile(path));
  } catch (const Json::parse_error& error) {
    throw InputError(
        fmt::format("{}: is not JSON ({}); correct it", path, onOneLine(error.what())));
  }
  const Origin whole{path};
  if (!file.is_object()) {
    whole.fail("is not a JSON object; write {\"NAME\": {\"reflectance\": 0.5}}");
  }
  for (const auto& [name, properties] : file.items()) {
    if (!properties.is_object()) {
      whole.fail(
          fmt::format("{} is not an object; write \"{}\": {{\"reflectance\": 0.5}}", name, name));
    }
    for (const auto& [property, value] : properties.items()) {
      const Origin origin{fmt::format("{}: {}.{}", path, name, property)};
      setProperty(name, property, bandsOf(value, origin), origin);
    }
  }
}

void applySet(const std::string& text, Overrides& overrides) {
  const Origin origin{"--set " + text};
  // Names may hold dots and equals signs: the value begins at the last '=', the property at the
  // last '.' before it.
  const std::size_t equals = text.rfind('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0) {
    origin.fail("is not NAME.PROPERTY=VALUE, for example lamp.emission=17,12,4");
  }
  const std::string_view value_text = trimmed(std::string_view(text).substr(equals + 1));
  std::optional<Vec3> value = parseTriple(value_text);
  if (const std::optional<double> number = parseNumber(value_text)) value = Vec3(*number);
  if (!value) {
    origin.fail(fmt::format("`{}` is not one finite number or three with commas", value_text));
  }
  overrides.setProperty(text.substr(0, dot),
                        std::string(trimmed(text.substr(dot + 1, equals - dot - 1))), *value,
                        origin);
}

}  // namespace

void applyOverrides(Scene& scene, const SceneOptions& options) {
  options.validate();
  // All or nothing: an override that fails leaves the caller's scene as it was.
  std::vector<Material> materials = scene.materials;
  std::vector<Surface> surfaces = scene.surfaces;
  std::vector<Note> notes = scene.notes;
  try {
    Overrides overrides(scene);
    if (!options.materials_file.empty()) overrides.readMaterialsFile(options.materials_file);
    for (const std::string& text : options.set) applySet(text, overrides);
    for (const std::string& name : options.one_sided) {
      overrides.setSides(name, false, {"--one-sided " + name});
    }
    for (const std::string& name : options.two_sided) {
      overrides.setSides(name, true, {"--two-sided " + name});
    }
  } catch (...) {
    scene.materials = std::move(materials);
    scene.surfaces = std::move(surfaces);
    scene.notes = std::move(notes);
    throw;
  }
}

}  // namespace radiosity
