#include "scene/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/finite.h"
#include "base/srgb.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

std::string UniqueNames::make(const std::string& wanted) {
  if (taken_.insert(wanted).second) return wanted;
  std::size_t& number = last_number_.try_emplace(wanted, 1).first->second;
  for (;;) {
    std::string name = fmt::format("{}#{}", wanted, ++number);
    if (taken_.insert(name).second) return name;
  }
}

UniqueNames lightNames(std::string_view free) {
  UniqueNames names;
  for (const Light& kind : lightKinds()) {
    if (kind.name != free) names.make(kind.name);
  }
  return names;
}

void FeatureNotes::add(const std::string& feature, const std::string& name, Severity severity,
                       std::size_t shown) {
  const auto [place, is_new] = entry_of_.try_emplace(feature, entries_.size());
  if (is_new) entries_.push_back({feature, severity, shown, {}, {}});
  Entry& entry = entries_[place->second];
  if (entry.seen.insert(name).second) entry.names.push_back(name);
}

void FeatureNotes::appendTo(std::vector<Note>& notes) const {
  for (const Entry& entry : entries_) {
    notes.push_back({entry.severity, entry.feature + ": " + joinNames(entry.names, entry.shown)});
  }
}

SceneBuilder::SceneBuilder(Scene& scene, const SceneOptions& options)
    : scene_(scene), options_(options) {
  scene_.face_offset.assign(1, 0);
}

Index SceneBuilder::surface(const std::string& object, Index material) {
  const auto [place, is_new] =
      surface_of_.try_emplace({object, material}, Index(scene_.surfaces.size()));
  if (is_new) {
    scene_.surfaces.push_back({object, material, ""});
    lacks_texcoords_.push_back(false);
  }
  return place->second;
}

void SceneBuilder::addFace(std::span<const Index> corners, std::span<const Vec2> texcoords,
                           Index surface, std::size_t element, std::span<const Vec3> colours) {
  constexpr std::size_t kMostCorners = std::size_t(1) << 28;
  if (scene_.corners.size() + corners.size() > kMostCorners) {
    throw InputError(fmt::format("{}: its faces have more than {} corners; split the scene",
                                 scene_.file, kMostCorners));
  }
  scene_.corners.insert(scene_.corners.end(), corners.begin(), corners.end());
  scene_.face_offset.push_back(scene_.corners.size());
  scene_.face_surface.push_back(surface);
  scene_.face_element.push_back(element);
  if (texcoords.empty()) {
    lacks_texcoords_[surface] = true;
    scene_.texcoords.resize(scene_.corners.size(), Vec2(0.0));
  } else {
    scene_.texcoords.insert(scene_.texcoords.end(), texcoords.begin(), texcoords.end());
  }
  if (colours.empty() && scene_.colours.empty()) return;
  // Faces before the first coloured one are white.
  scene_.colours.resize(scene_.corners.size() - colours.size(), Vec3(1.0));
  scene_.colours.insert(scene_.colours.end(), colours.begin(), colours.end());
}

void SceneBuilder::finish() {
  dropUnusableTextures();
  nameSurfaces();
}

void SceneBuilder::nameSurfaces() {
  UniqueNames names;
  std::set<std::string> of_materials;
  for (const Material& material : scene_.materials) of_materials.insert(material.name);
  std::map<std::string, int> surfaces_of;
  for (const Surface& surface : scene_.surfaces) ++surfaces_of[surface.object];
  for (Surface& surface : scene_.surfaces) {
    const std::string& material = scene_.materials[surface.material].name;
    // Exporters often give an object and its material the same name.
    const bool one_name = surface.object == material ||
                          (material == kNoMaterial && surfaces_of[surface.object] == 1 &&
                           !of_materials.contains(surface.object));
    surface.name = names.make(one_name ? surface.object : surface.object + "/" + material);
  }
}

void SceneBuilder::dropUnusableTextures() {
  FeatureNotes notes;
  bool textured = false;
  for (std::size_t s = 0; s < scene_.surfaces.size(); ++s) {
    Surface& surface = scene_.surfaces[s];
    if (!isTextured(scene_.materials[surface.material])) continue;
    if (!lacks_texcoords_[s]) {
      textured = true;
      continue;
    }
    Material plain = scene_.materials[surface.material];
    const std::string name = surface.object + "/" + plain.name;
    if (std::exchange(plain.texture, kNone) != kNone) {
      notes.add("texture not used, faces without texture coordinates; the factor alone counts",
                name, Severity::warning);
      if (plain.reflectance == Vec3(1.0)) replaceStandIn(plain, name, "factor", options_, notes);
    }
    // A surface that emits all over would be worse than one that does not emit.
    if (std::exchange(plain.emission_texture, kNone) != kNone) {
      plain.emission = Vec3(0.0);
      notes.add("emission texture not used, faces without texture coordinates; they EMIT NOTHING",
                name, Severity::loud);
    }
    surface.material = Index(scene_.materials.size());
    scene_.materials.push_back(std::move(plain));
  }
  if (!textured) scene_.texcoords.clear();
  notes.appendTo(scene_.notes);
}

Material defaultMaterial(const std::string& name, const SceneOptions& options) {
  Material material;
  material.name = name;
  material.reflectance = Vec3(options.default_reflectance);
  return material;
}

std::optional<Vec3> factorOfColour(const Vec3& colour, VertexColours meaning) {
  Vec3 factor = colour;
  for (int band = 0; band < 3; ++band) {
    if (!(colour[band] >= 0 && colour[band] <= 1)) return std::nullopt;
    if (meaning == VertexColours::srgb) factor[band] = linearFromSrgb(colour[band]);
  }
  return factor;
}

Note noMaterialNote(const std::vector<std::string>& names, bool coloured,
                    const SceneOptions& options) {
  const std::string what =
      coloured ? "no material; the colours of vertices are the reflectance"
               : fmt::format("no material, reflectance {}", options.default_reflectance);
  return {Severity::warning, what + ": " + joinNames(names)};
}

void replaceStandIn(Material& material, const std::string& name, const char* factor,
                    const SceneOptions& options, FeatureNotes& notes) {
  notes.add(fmt::format("{} is {} beside a texture that is not used: reflectance {}, material",
                        factor, material.reflectance.x, options.default_reflectance),
            name, Severity::warning);
  material.reflectance = Vec3(options.default_reflectance);
}

Vec3 settledReflectance(const Vec3& reflectance, const std::string& material, FeatureNotes& notes) {
  constexpr double kRounding = 1e-6;  // a few units in the last place of a float
  Vec3 settled = reflectance;
  for (int band = 0; band < 3; ++band) {
    if (settled[band] > 1 && settled[band] <= 1 + kRounding) settled[band] = 1;
  }
  if (isReflectance(settled) && settled != reflectance) {
    notes.add("reflectance above 1 by float rounding, taken as 1, material", material);
  }
  return settled;
}

bool isReflectance(const Vec3& reflectance) {
  return reflectance.x >= 0 && reflectance.x <= 1 && reflectance.y >= 0 && reflectance.y <= 1 &&
         reflectance.z >= 0 && reflectance.z <= 1;
}

bool isEmission(const Vec3& emission) {
  return isFinite(emission) && emission.x >= 0 && emission.y >= 0 && emission.z >= 0;
}

namespace {

/// All digits, so that the text shows what is wrong with 1.0000012.
std::string exactBands(const Vec3& value) {
  if (value.x == value.y && value.y == value.z) return fmt::format("{}", value.x);
  return fmt::format("{} {} {}", value.x, value.y, value.z);
}

std::string reflectanceFault(const Vec3& reflectance) {
  return fmt::format(
      "reflectance {} is outside 0 to 1; a surface returns no more light than it gets, scale it "
      "down",
      exactBands(reflectance));
}

std::string emissionFault(const Vec3& value, const char* unit) {
  return fmt::format("emission {} {} is not a finite value of 0 or more; correct it",
                     exactBands(value), unit);
}

}  // namespace

void checkReflectance(const std::string& where, const std::string& name, const Vec3& reflectance) {
  if (isReflectance(reflectance)) return;
  throw InputError(fmt::format("{}: material {}: {}", where, name, reflectanceFault(reflectance)));
}

void checkEmission(const std::string& where, const std::string& name, const Vec3& emission) {
  if (isEmission(emission)) return;
  throw InputError(
      fmt::format("{}: material {}: {}", where, name, emissionFault(emission, "W/m^2")));
}

std::string solidFeature() {
  return fmt::format(
      "transparency is not used: it is solid and blocks light ({} leaves it out), material",
      spelled("without", "NAME"));
}

std::string maskFeature() {
  return fmt::format(
      "holes (alpha masks) are not cut out: it is solid and blocks light ({} leaves it out), "
      "material",
      spelled("without", "NAME"));
}

bool mayMend(const SceneOptions& options) {
  return !options.set.empty() || !options.materials_file.empty() || !options.without.empty();
}

void requireMaterial(const std::string& where, const Material& material) {
  const bool reflects = isReflectance(material.reflectance);
  if (reflects && isEmission(material.emission)) return;
  throw InputError(fmt::format(
      "{}: material {}: {}, or {}", where, material.name,
      reflects ? emissionFault(material.radiance(), "W/m^2/sr")
               : reflectanceFault(material.reflectance),
      spelled("set",
              fmt::format("'{}.{}'", material.name, reflects ? "radiance=0" : "reflectance=0.8"))));
}

void requireMaterials(Scene& scene, const SceneOptions& options) {
  std::vector<std::uint8_t> used(scene.materials.size(), 0);
  for (const Index surface : scene.face_surface) used[scene.surfaces[surface].material] = 1;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    Material& material = scene.materials[m];
    if (used[m] != 0) requireMaterial(scene.file, material);
    if (isReflectance(material.reflectance) && isEmission(material.emission)) continue;
    scene.notes.push_back(
        {Severity::warning,
         fmt::format("material {}: no face has it; its reflectance {} or emission {} W/m^2 is out "
                     "of range, reflectance {} and none are taken",
                     material.name, exactBands(material.reflectance), exactBands(material.emission),
                     options.default_reflectance)});
    material.reflectance = Vec3(options.default_reflectance);
    material.emission = Vec3(0.0);
  }
}

}  // namespace radiosity
