#include "scene/surface_names.h"

#include <algorithm>
#include <set>

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

}  // namespace radiosity
