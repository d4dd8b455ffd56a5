#include "scene/radiance/radiance_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "radiosity/spelling.h"

namespace radiosity {

namespace {

bool isOne(const RadiancePrimitive& primitive, std::initializer_list<const char*> words) {
  return std::ranges::any_of(words, [&](const char* word) { return primitive.is(word); });
}

/// A glow of a negative radius is seen, and lights nothing.
bool isLightless(const RadiancePrimitive& given) {
  return given.is("glow") && given.numbers[3] < 0;
}

}  // namespace

bool RadianceModifiers::emits() const {
  return isOne(*material, {"light", "glow", "illum"}) && !isLightless(*material);
}

Vec3 RadianceModifiers::radiance() const { return material->three(0); }

RadianceModifiers modifiersOf(const RadianceReader& reader, const RadiancePrimitive& surface) {
  RadianceModifiers found;
  // A modifier knows those before it alone, so that the way ends.
  for (Index k = surface.modifier; k != kNone; k = reader.modifiers()[k].modifier) {
    const RadiancePrimitive& modifier = reader.modifiers()[k];
    const RadianceKind kind = modifier.type->kind;
    if (kind == RadianceKind::pattern) {
      if (found.pattern == nullptr) found.pattern = &modifier;
    } else if (kind == RadianceKind::bump) {
      if (found.bump == nullptr) found.bump = &modifier;
    } else if (found.material == nullptr) {
      found.material = &modifier;
    }
  }
  return found;
}

Index RadianceMaterials::of(const RadiancePrimitive& surface) {
  const RadianceModifiers modifiers = modifiersOf(reader_, surface);
  const RadiancePrimitive* given = modifiers.material;
  if (given == nullptr) {
    reader_.fail(surface, "has no material among its modifiers; give it one, e.g. plastic");
  }
  if (isOne(*given, {"antimatter", "mist"})) {
    notes_.add(fmt::format("surfaces of {} are left out", given->type->word), surface.name,
               Severity::warning);
    return kNone;
  }
  const auto [place, is_new] =
      made_.try_emplace({given, modifiers.pattern}, Index(scene_.materials.size()));
  if (is_new) scene_.materials.push_back(make(modifiers));
  return place->second;
}

Material RadianceMaterials::make(const RadianceModifiers& modifiers) {
  const RadiancePrimitive& given = *modifiers.material;
  Material material = defaultMaterial(names_.make(given.name), options_);
  if (modifiers.bump != nullptr) {
    notes_.add("bumps (texfunc, texdata) are not used: all is smooth, material", material.name);
  }
  if (isOne(given, {"light", "glow", "illum", "spotlight"})) {
    return ofEmitter(modifiers, std::move(material));
  }
  if (modifiers.pattern != nullptr) {
    notes_.add(fmt::format("{} is not used, the colour alone counts, material",
                           modifiers.pattern->type->word),
               material.name, Severity::warning);
  }
  // From both sides alike.
  material.two_sided = true;
  return ofReflector(given, std::move(material));
}

/// Lamps reflect nothing, and shine from their front.
Material RadianceMaterials::ofEmitter(const RadianceModifiers& modifiers, Material material) {
  const RadiancePrimitive& given = *modifiers.material;
  material.reflectance = Vec3(0.0);
  if (given.is("spotlight")) {
    notes_.add(fmt::format("spotlight is not read, its surfaces EMIT NOTHING ({} has such a lamp), "
                           "material",
                           spelled("light", "spot,...")),
               material.name, Severity::loud);
    return material;
  }
  if (isLightless(given)) {
    notes_.add("a glow of a negative radius lights nothing, and is black, material", material.name);
    return material;
  }
  if (modifiers.pattern != nullptr) {
    notes_.add(fmt::format("the {} of a lamp is not read, its surfaces EMIT NOTHING (give the lamp "
                           "by its photometric file, {}), material",
                           modifiers.pattern->type->word, spelled("light", "ies,FILE,at=X,Y,Z")),
               material.name, Severity::loud);
    return material;
  }
  if (given.is("glow") && given.numbers[3] > 0) {
    notes_.add("a glow lights all of the scene, whatever its radius, material", material.name);
  }
  if (given.is("illum")) {
    notes_.add("an illum is solid and shines as a light does, material", material.name,
               Severity::warning);
  }
  material.emission = std::numbers::pi * modifiers.radiance();
  return material;
}

Material RadianceMaterials::ofReflector(const RadiancePrimitive& given, Material material) {
  const bool trans = isOne(given, {"trans", "trans2"});
  if (trans || isOne(given, {"plastic", "metal", "plastic2", "metal2", "mirror"})) {
    material.reflectance = given.three(0);
    if (given.is("mirror") || given.numbers[3] != 0) {
      notes_.add("specularity and roughness are not used: all of its colour is matt, material",
                 material.name);
    }
    if (trans) {
      const double share = given.numbers[given.numbers.size() - 2];
      if (!(share >= 0 && share <= 1)) {
        reader_.fail(given, fmt::format("its transmissivity {} is not 0 to 1; correct it", share));
      }
      material.reflectance *= 1 - share;
      if (share > 0) notes_.add(solidFeature(), material.name, Severity::warning);
    }
    material.reflectance = settledReflectance(material.reflectance, material.name, notes_);
    return material;
  }
  if (isOne(given, {"glass", "dielectric", "interface"})) {
    material.reflectance = Vec3(0.0);
    notes_.add(solidFeature(), material.name, Severity::warning);
    return material;
  }
  notes_.add(fmt::format("{} is not read, reflectance {}, material", given.type->word,
                         options_.default_reflectance),
             material.name, Severity::warning);
  return material;
}

}  // namespace radiosity
