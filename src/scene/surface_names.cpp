#include "scene/surface_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "base/name_pattern.h"
#include "base/near_names.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

std::vector<Index> surfacesNamed(const Scene& scene, const std::string& name) {
  const auto materialOf = [&](Index s) -> const std::string& {
    return scene.materials[scene.surfaces[s].material].name;
  };
  std::vector<Index> surfaces;
  std::vector<Index> with_material;
  std::vector<Index> of_object;
  for (Index s = 0; s < scene.surfaces.size(); ++s) {
    if (scene.surfaces[s].name == name) surfaces.push_back(s);
    if (materialOf(s) == name) with_material.push_back(s);
    if (scene.surfaces[s].object == name) of_object.push_back(s);
  }
  // A surface has its material's name if its object has the same name. Then the name means the
  // material, wherever it is used.
  const bool is_material = surfaces.empty() || std::ranges::any_of(surfaces, [&](Index s) {
                             return materialOf(s) == name;
                           });
  if (is_material && !with_material.empty()) return with_material;
  return surfaces.empty() ? of_object : surfaces;
}

std::vector<Index> surfacesMatching(const Scene& scene, const std::string& pattern) {
  std::vector<Index> found;
  for (Index s = 0; s < scene.surfaces.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    if (matchesPattern(pattern, surface.name) || matchesPattern(pattern, surface.object) ||
        matchesPattern(pattern, scene.materials[surface.material].name)) {
      found.push_back(s);
    }
  }
  return found;
}

std::vector<Index> surfacesMeant(const Scene& scene, const std::string& name) {
  std::vector<Index> found = surfacesNamed(scene, name);
  if (!found.empty()) return found;
  if (isPattern(name)) return surfacesMatching(scene, name);
  if (name != kAllSurfaces) return {};
  found.resize(scene.surfaces.size());
  std::iota(found.begin(), found.end(), Index(0));
  return found;
}

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

std::string flipOption(const std::vector<std::string>& names, std::size_t all) {
  constexpr std::size_t kFew = 6;
  if (names.size() == all) return spelled("flip", "all");
  std::string text;
  for (std::size_t k = 0; k < std::min(kFew, names.size()); ++k) {
    text += (k == 0 ? "" : " ") + spelled("flip", fmt::format("'{}'", names[k]));
  }
  return names.size() > kFew ? text + " and so on" : text;
}

std::string unknownNameText(const Scene& scene, const std::string& name) {
  constexpr std::size_t kMostNames = 40;
  std::vector<std::string> known = knownNames(scene);
  bool any_light = false;
  for (const Light& light : scene.lights) {
    if (light.isUniform()) continue;
    any_light = true;
    known.push_back(light.name);
  }
  const std::vector<std::string> names = nearestFirst(name, std::move(known));
  return fmt::format("no surface, material{} object{} {} {}; there are: {}",
                     any_light ? "," : " or", any_light ? " or light" : "",
                     isPattern(name) ? "matches" : "is called", name, joinNames(names, kMostNames));
}

}  // namespace radiosity
