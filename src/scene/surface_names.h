// Names of surfaces, materials and objects.
#pragma once

#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The surfaces that `name` stands for, ascending, as in SceneOptions::set; empty if nothing has
/// that name.
std::vector<Index> surfacesNamed(const Scene& scene, const std::string& name);

/// Every name of a material, an object and a surface, each once.
std::vector<std::string> knownNames(const Scene& scene);

}  // namespace radiosity
