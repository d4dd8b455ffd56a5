#include "scene/three_mf/three_mf_materials.h"

#include <fmt/format.h>

#include <charconv>

#include "base/parse.h"
#include "base/srgb.h"

namespace radiosity {

Index ThreeMfMaterials::of(const ThreeMfModel& model, const std::string& group,
                           const std::string& member, const std::string& object) {
  const auto [place, is_new] = known_.try_emplace({&model, group, member}, kNone);
  if (is_new) place->second = read(model, group, member, object);
  if (place->second == kNone) {
    notes_.add(
        "textures and mixed materials (texture2dgroup, compositematerials, multiproperties) are "
        "not read, default reflectance for",
        object, Severity::warning);
  }
  return place->second;
}

Index ThreeMfMaterials::read(const ThreeMfModel& model, const std::string& group,
                             const std::string& member, const std::string& object) {
  const auto found = model.resources.find(group);
  if (found == model.resources.end()) {
    package_.fail(fmt::format(
        "object {}: its group of materials {} does not exist; export it again", object, group));
  }
  const std::string_view kind = localName(found->second.name());
  const bool is_base = kind == "basematerials";
  if (!is_base && kind != "colorgroup") return kNone;
  const std::optional<long long> number = parseInteger(member);
  long long count = 0;
  for (const pugi::xml_node child : found->second.children()) {
    if (localName(child.name()) != (is_base ? "base" : "color") || count++ != number) continue;
    const std::string colour = child.attribute(is_base ? "displaycolor" : "color").value();
    std::string name = is_base ? child.attribute("name").value() : "colour " + colour.substr(0, 7);
    if (name.empty()) name = fmt::format("material {} of group {}", member, group);
    return added(name, colour);
  }
  package_.fail(
      fmt::format("object {}: member `{}` of its group of materials {} does not exist; "
                  "export it again",
                  object, member, group));
}

Index ThreeMfMaterials::added(const std::string& name, const std::string& colour) {
  const auto [place, is_new] = added_.try_emplace({name, colour}, Index(scene_.materials.size()));
  if (!is_new) return place->second;
  Material material = defaultMaterial(names_.make(name), options_);
  material.reflectance = reflectanceOf(name, colour);
  if (colour.size() == 9 && !colour.ends_with("FF") && !colour.ends_with("ff")) {
    notes_.add(solidFeature(), material.name, Severity::warning);
  }
  scene_.materials.push_back(std::move(material));
  return place->second;
}

/// The reflectance of "#RRGGBB" or "#RRGGBBAA", coded as sRGB.
Vec3 ThreeMfMaterials::reflectanceOf(const std::string& name, const std::string& colour) const {
  unsigned long value = 0;
  const char* const end = colour.data() + colour.size();
  const bool has_length = colour.size() == 7 || colour.size() == 9;
  const auto parsed =
      has_length ? std::from_chars(colour.data() + 1, end, value, 16) : std::from_chars_result{};
  if (!has_length || colour[0] != '#' || parsed.ptr != end) {
    package_.fail(fmt::format(
        "material {}: its colour `{}` is not #RRGGBB or #RRGGBBAA; correct it", name, colour));
  }
  if (colour.size() == 9) value >>= 8U;
  Vec3 reflectance;
  for (int band = 0; band < 3; ++band) {
    const auto code = double((value >> (16U - 8U * unsigned(band))) & 0xffU);
    reflectance[band] = linearFromSrgb(code / 255);
  }
  return reflectance;
}

Index ThreeMfMaterials::ownOf(const std::string& object) {
  const auto [place, is_new] = own_.try_emplace(object, Index(scene_.materials.size()));
  if (is_new) {
    notes_.add(fmt::format("no material, reflectance {}", options_.default_reflectance), object,
               Severity::warning);
    scene_.materials.push_back(defaultMaterial(names_.make(object), options_));
  }
  return place->second;
}

}  // namespace radiosity
