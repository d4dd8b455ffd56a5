// Changes materials, sides and what there is by name, after reading.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "base/input_file.h"
#include "base/name_pattern.h"
#include "base/parse.h"
#include "radiosity/spelling.h"
#include "scene/checks/checks.h"
#include "scene/face_edits.h"
#include "scene/json_scan.h"
#include "scene/lights/light_text.h"
#include "scene/scene_builder.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// The origin of an override and its text there: "set='lamp.emission=17'".
struct Origin {
  std::string text;
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", text, what));
  }
};

/// Of materials.
constexpr std::string_view kProperties[] = {"reflectance", "tint", "emission", "radiance"};

Vec3 coloursOf(const Light& light) {
  return {light.strength[0], light.strength[1], light.strength[2]};
}

class Overrides {
 public:
  explicit Overrides(Scene& scene);

  /// The materials that `name` stands for. No other surface uses them: a surface that shares its
  /// material gets a copy.
  std::vector<Index> materialsOf(const std::string& name, const Origin& origin);
  void setProperty(const std::string& name, const std::string& property, const Vec3& value,
                   const Origin& origin);
  void setSides(const std::string& name, bool two_sided, const Origin& origin);
  /// The surfaces that `name` stands for.
  std::vector<Index> surfacesOf(const std::string& name, const Origin& origin) const;
  void replace(Light light, Up up);
  /// Whether it is a light that has the property, not a material that goes by the same name.
  bool isOfLight(const std::string& name, const std::string& property) const;
  void setLightProperty(const std::string& name, const std::string& property,
                        const std::string& value, const Origin& origin);
  /// Whether there was one that `name` or a pattern stands for.
  bool leaveOutLights(const std::string& name);
  void readMaterialsFile(const std::string& path);
  void noteRounding() { rounded_.appendTo(scene_.notes); }

 private:
  using ByName = std::unordered_map<std::string, std::vector<Index>>;
  static const std::vector<Index>& found(const ByName& index, const std::string& name) {
    static const std::vector<Index> kNothing;
    const auto place = index.find(name);
    return place == index.end() ? kNothing : place->second;
  }
  std::vector<Light>::iterator lightNamed(const std::string& name) const {
    return std::ranges::find(scene_.lights, name, &Light::name);
  }
  Index ownMaterial(Index surface, std::span<const Index> chosen);
  void note(std::string text) { scene_.notes.push_back({Severity::info, std::move(text)}); }
  void noteUnused(const std::string& name, Index material);
  /// Notes the changes, each once, with the materials that a pattern or "all" stood for.
  void noteChanges(const std::string& name,
                   const std::map<std::string, std::set<std::string>>& materials_of);
  // Each returns the change in words.
  std::string setReflectance(Material& material, const Vec3& given, const Origin& origin);
  std::string setTint(Material& material, const Vec3& value, const Origin& origin);
  std::string setEmission(Material& material, const Vec3& value, const Origin& origin);
  std::string dropTexture(Index& texture, const char* instead) const;
  std::string dropColours(Index material);

  Scene& scene_;
  FeatureNotes rounded_;
  ByName surfaces_called_;
  ByName surfaces_of_object_;
  ByName materials_called_;
  std::vector<std::vector<Index>> surfaces_with_;  ///< by material
};

Overrides::Overrides(Scene& scene) : scene_(scene), surfaces_with_(scene.materials.size()) {
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    surfaces_called_[surface.name].push_back(Index(s));
    surfaces_of_object_[surface.object].push_back(Index(s));
    surfaces_with_[surface.material].push_back(Index(s));
  }
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    materials_called_[scene.materials[m].name].push_back(Index(m));
  }
}

std::vector<Index> Overrides::materialsOf(const std::string& name, const Origin& origin) {
  const std::vector<Index>& called = found(materials_called_, name);
  std::vector<Index> chosen = found(surfaces_called_, name);
  // A surface has its material's name if its object has the same name. Then the name means the
  // material, wherever it is used.
  const bool is_material =
      chosen.empty() || std::any_of(chosen.begin(), chosen.end(), [&](Index s) {
        return scene_.materials[scene_.surfaces[s].material].name == name;
      });
  if (is_material && !called.empty()) return called;
  if (chosen.empty()) chosen = found(surfaces_of_object_, name);
  if (chosen.empty()) chosen = surfacesOf(name, origin);
  std::vector<Index> materials;
  std::set<Index> seen;
  for (const Index s : chosen) {
    const Index material = ownMaterial(s, chosen);
    if (seen.insert(material).second) materials.push_back(material);
  }
  return materials;
}

std::vector<Index> Overrides::surfacesOf(const std::string& name, const Origin& origin) const {
  std::vector<Index> surfaces = surfacesMeant(scene_, name);
  if (surfaces.empty()) origin.fail(unknownNameText(scene_, name));
  return surfaces;
}

/// The material of `surface`, which only the `chosen` surfaces, ascending, share after the call.
Index Overrides::ownMaterial(Index surface, std::span<const Index> chosen) {
  const Index material = scene_.surfaces[surface].material;
  std::vector<Index> ours;
  std::vector<Index> others;
  for (const Index s : surfaces_with_[material]) {
    (std::binary_search(chosen.begin(), chosen.end(), s) ? ours : others).push_back(s);
  }
  if (others.empty()) return material;
  const auto copy = Index(scene_.materials.size());
  scene_.materials.push_back(Material(scene_.materials[material]));
  materials_called_[scene_.materials[copy].name].push_back(copy);
  for (const Index s : ours) scene_.surfaces[s].material = copy;
  surfaces_with_[material] = std::move(others);
  surfaces_with_.push_back(std::move(ours));
  return copy;
}

std::string withTexture(const Vec3& factor, Index texture) {
  return describeBands(factor) + (texture == kNone ? "" : " x texture");
}

std::string Overrides::setTint(Material& material, const Vec3& value, const Origin& origin) {
  const Vec3 tinted = settledReflectance(material.reflectance * value, material.name, rounded_);
  checkReflectance(origin.text, material.name, tinted);
  const std::string before = withTexture(material.reflectance, material.texture);
  material.reflectance = tinted;
  return fmt::format("reflectance {} -> {}", before, withTexture(tinted, material.texture));
}

void Overrides::setProperty(const std::string& name, const std::string& property, const Vec3& value,
                            const Origin& origin) {
  const bool emission = property == "emission" || property == "radiance";
  if (std::ranges::find(kProperties, property) == std::end(kProperties)) {
    origin.fail(fmt::format("`{}` is none of {}", property, fmt::join(kProperties, ", ")));
  }
  const Vec3 asked = property == "radiance" ? std::numbers::pi * value : value;
  std::map<std::string, std::set<std::string>> changes;
  for (const Index m : materialsOf(name, origin)) {
    Material& material = scene_.materials[m];
    const std::string change = emission             ? setEmission(material, asked, origin)
                               : property == "tint" ? setTint(material, asked, origin)
                                                    : setReflectance(material, asked, origin);
    const std::string dropped = property == "reflectance" ? dropColours(m) : "";
    changes[change + dropped].insert(scene_.materials[m].name);
    noteUnused(name, m);
  }
  noteChanges(name, changes);
}

void Overrides::noteChanges(const std::string& name,
                            const std::map<std::string, std::set<std::string>>& materials_of) {
  const bool literal = materials_called_.contains(name) || surfaces_called_.contains(name) ||
                       surfaces_of_object_.contains(name);
  for (const auto& [change, materials] : materials_of) {
    const std::vector<std::string> names(materials.begin(), materials.end());
    note(literal ? fmt::format("{}: {}", name, change)
                 : fmt::format("{} ({}): {}", name, joinNames(names), change));
  }
}

// A value that was asked for replaces the texture, which would multiply it. The texture is named.
std::string Overrides::dropTexture(Index& texture, const char* instead) const {
  if (texture == kNone) return {};
  const std::string dropped = scene_.textures[std::exchange(texture, kNone)].name;
  return fmt::format("; its texture {} is dropped{}", dropped, instead);
}

/// The same for vertex colours.
std::string Overrides::dropColours(Index material) {
  bool dropped = false;
  for (std::size_t f = 0; f < scene_.faceCount() && !scene_.colours.empty(); ++f) {
    if (scene_.surfaces[scene_.face_surface[f]].material != material) continue;
    for (std::size_t k = scene_.face_offset[f]; k < scene_.face_offset[f + 1]; ++k) {
      dropped = dropped || scene_.colours[k] != Vec3(1.0);
      scene_.colours[k] = Vec3(1.0);
    }
  }
  return dropped ? "; its vertex colours are dropped (tint keeps them)" : "";
}

std::string Overrides::setReflectance(Material& material, const Vec3& given, const Origin& origin) {
  const Vec3 value = settledReflectance(given, material.name, rounded_);
  checkReflectance(origin.text, material.name, value);
  const std::string before = withTexture(material.reflectance, material.texture);
  material.reflectance = value;
  return fmt::format("reflectance {} -> {}", before, describeBands(value)) +
         dropTexture(material.texture, " (tint keeps it)");
}

std::string Overrides::setEmission(Material& material, const Vec3& value, const Origin& origin) {
  checkEmission(origin.text, material.name, value);
  const std::string before = withTexture(material.emission, material.emission_texture);
  material.emission = value;
  return fmt::format("emission {} -> {} W/m^2", before, describeBands(value)) +
         dropTexture(material.emission_texture, "");
}

void Overrides::replace(Light light, Up up) {
  light.settle(up);
  light.validate();
  const auto before = std::ranges::find(scene_.lights, light.name, &Light::name);
  const bool had_one = before != scene_.lights.end();
  const LightTraits& traits = light.traits();
  const std::string stands = standText(light, up);
  note(fmt::format("{}: {} {} -> {} {}{} {}", light.name, traits.strength,
                   describeBands(had_one ? coloursOf(*before) : Vec3(0.0)),
                   describeBands(coloursOf(light)), traits.unit,
                   light.photometric ? ", " + photometricText(3) + "," : "",
                   stands.empty() ? traits.from : stands));
  for (std::string& remark : light.remarks()) {
    if (std::ranges::find(scene_.notes, remark, &Note::text) != scene_.notes.end()) continue;
    scene_.notes.push_back({Severity::warning, std::move(remark)});
  }
  setLight(scene_.lights, std::move(light));
}

bool Overrides::isOfLight(const std::string& name, const std::string& property) const {
  const bool of_material = std::ranges::find(kProperties, property) != std::end(kProperties);
  return lightNamed(name) != scene_.lights.end() &&
         (!of_material || surfacesNamed(scene_, name).empty());
}

/// The light anew from its text, with one parameter changed.
void Overrides::setLightProperty(const std::string& name, const std::string& property,
                                 const std::string& value, const Origin& origin) {
  const Light& light = *lightNamed(name);
  const std::string text = fmt::format("{}{},{}={}", strengthText(light.strength),
                                       light.parametersText(), property, value);
  try {
    Light changed = lightOf(light.traits().word, text);
    if (property != light.traits().strength) changed.photometric = light.photometric;
    replace(std::move(changed), scene_.up);
  } catch (const InputError& error) {
    origin.fail(error.what());
  }
}

bool Overrides::leaveOutLights(const std::string& name) {
  std::vector<std::string> gone;
  for (const Light& light : scene_.lights) {
    const bool shown = light.name == name || (isPattern(name) && matchesPattern(name, light.name));
    if (shown && !light.isUniform()) gone.push_back(light.name);
  }
  std::erase_if(scene_.lights, [&](const Light& light) {
    return std::ranges::find(gone, light.name) != gone.end();
  });
  if (!gone.empty()) note(fmt::format("left out: {}", joinNames(gone)));
  return !gone.empty();
}

void Overrides::noteUnused(const std::string& name, Index material) {
  const std::vector<Index>& same_name = found(materials_called_, scene_.materials[material].name);
  const bool used = std::any_of(same_name.begin(), same_name.end(),
                                [&](Index m) { return !surfaces_with_[m].empty(); });
  if (used) return;
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
  for (const Index m : materialsOf(name, origin)) set(scene_.materials[m]);
  note(fmt::format("{}: {}-sided{}", name, two_sided ? "two" : "one",
                   changed == 0 ? ", as it was" : ""));
}

/// One "NAME": {"PROPERTY": VALUE} of a materials file.
struct FileEntry {
  std::string name;
  std::string property;
  std::vector<double> bands;
};

/// The entries in the order of the file: of two for one material the later counts.
std::vector<FileEntry> readEntries(const std::string& path) {
  std::vector<FileEntry> entries;
  const auto entryAt = [&](std::span<const JsonStep> at) {
    return Origin{fmt::format("{}: {}.{}", path, at[0].key, at[1].key)};
  };
  constexpr const char* kBands = "give one number or three in brackets: [0.6, 0.1, 0.1]";
  const auto visit = [&](std::span<const JsonStep> at, const JsonValue& value) {
    const bool object = value.kind == JsonKind::object;
    const bool ends = value.kind == JsonKind::end;
    if (at.empty()) {
      if (object || ends) return;
      Origin{path}.fail("is not a JSON object; write {\"NAME\": {\"reflectance\": 0.5}}");
    }
    if (at.size() == 1) {
      if (object || ends) return;
      Origin{path}.fail(
          fmt::format("{0} is not an object; write \"{0}\": {{\"reflectance\": 0.5}}", at[0].key));
    }
    const bool number = value.kind == JsonKind::number;
    if (at.size() == 2 && !ends) {
      if (!number && value.kind != JsonKind::array) entryAt(at).fail(kBands);
      entries.push_back({at[0].key, at[1].key, {}});
      if (number) entries.back().bands.assign(3, value.number);
    } else if (at.size() == 2) {
      if (entries.back().bands.size() != 3) entryAt(at).fail(kBands);
    } else {
      if (!number || entries.back().bands.size() == 3) entryAt(at).fail(kBands);
      entries.back().bands.push_back(value.number);
    }
  };
  scanJson(path, readWholeFile(path), visit);
  return entries;
}

void Overrides::readMaterialsFile(const std::string& path) {
  for (const FileEntry& entry : readEntries(path)) {
    setProperty(entry.name, entry.property, {entry.bands[0], entry.bands[1], entry.bands[2]},
                {fmt::format("{}: {}.{}", path, entry.name, entry.property)});
  }
}

void applySet(const std::string& text, Overrides& overrides) {
  const Origin origin{spelled("set", text)};
  // Names may contain dots and equals signs: the value begins after the last '=', the property
  // after the last '.' before it.
  const std::size_t equals = text.rfind('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0) {
    origin.fail("is not NAME.PROPERTY=VALUE, for example lamp.emission=17,12,4");
  }
  const std::string_view value_text = trimmed(std::string_view(text).substr(equals + 1));
  const std::string name = text.substr(0, dot);
  const std::string property(trimmed(text.substr(dot + 1, equals - dot - 1)));
  if (overrides.isOfLight(name, property)) {
    overrides.setLightProperty(name, property, std::string(value_text), origin);
    return;
  }
  std::optional<Vec3> value = parseTriple(value_text);
  if (const std::optional<double> number = parseNumber(value_text)) value = Vec3(*number);
  if (!value) {
    origin.fail(fmt::format("`{}` is not one finite number or three with commas", value_text));
  }
  overrides.setProperty(name, property, *value, origin);
}

/// Notes materials of reflectance 1, unless an equal note is there already.
void noteWhiteMaterials(Scene& scene) {
  std::optional<Note> white = whiteMaterials(scene);
  if (!white) return;
  const auto isSame = [&](const Note& note) { return note.text == white->text; };
  if (std::ranges::none_of(scene.notes, isSame)) scene.notes.push_back(std::move(*white));
}

}  // namespace

void SceneOverrides::validate() const {
  for (const Light& light : lights) light.validate();
}

void applyOverrides(Scene& scene, const SceneOverrides& given) {
  given.validate();
  FaceEdits edits(scene);
  // We change a copy, so that a failing override leaves the caller's scene unchanged.
  std::vector<Material> materials = scene.materials;
  std::vector<Surface> surfaces = scene.surfaces;
  std::vector<Note> notes = scene.notes;
  std::vector<Light> lights = scene.lights;
  const Up up = scene.up;
  try {
    Overrides overrides(scene);
    if (given.up) scene.up = *given.up;
    if (!given.materials_file.empty()) overrides.readMaterialsFile(given.materials_file);
    for (const std::string& text : given.set) applySet(text, overrides);
    for (const std::string& name : given.one_sided) {
      overrides.setSides(name, false, {spelled("one_sided", name)});
    }
    for (const std::string& name : given.two_sided) {
      overrides.setSides(name, true, {spelled("two_sided", name)});
    }
    for (const std::string& name : given.flip) {
      edits.flip(name, overrides.surfacesOf(name, {spelled("flip", name)}));
    }
    for (const std::string& name : given.without) {
      const bool any = overrides.leaveOutLights(name);
      if (any && surfacesMeant(scene, name).empty()) continue;
      edits.leaveOut(name, overrides.surfacesOf(name, {spelled("without", name)}));
    }
    edits.requireFaces();
    overrides.noteRounding();
    for (const Light& light : given.lights) overrides.replace(light, scene.up);
    settleSkies(scene.lights, scene.up);
  } catch (...) {
    scene.lights = std::move(lights);
    scene.up = up;
    scene.materials = std::move(materials);
    scene.surfaces = std::move(surfaces);
    scene.notes = std::move(notes);
    throw;
  }
  edits.apply();
  noteWhiteMaterials(scene);
}

}  // namespace radiosity
