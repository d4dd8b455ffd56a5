// What a name stands for: a surface, a material or an object.
#pragma once

#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The surfaces that `name` stands for, ascending, as SceneOptions::set finds them; none where
/// nothing has that name.
std::vector<Index> surfacesNamed(const Scene& scene, const std::string& name);

/// Every name of a material, an object and a surface, each once.
std::vector<std::string> knownNames(const Scene& scene);

}  // namespace radiosity
