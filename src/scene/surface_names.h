// Names of surfaces, materials and objects.
#pragma once

#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The surfaces that `name` stands for literally, ascending; empty if nothing has that name.
std::vector<Index> surfacesNamed(const Scene& scene, const std::string& name);

/// The surfaces whose name, object or material matches `pattern` (base/name_pattern.h), ascending.
std::vector<Index> surfacesMatching(const Scene& scene, const std::string& pattern);

/// Stands for every surface, unless something is called so.
inline constexpr const char* kAllSurfaces = "all";

/// The surfaces that `name` stands for, ascending: literally, as "all" or as a pattern, tried in
/// this order. Empty if none does.
std::vector<Index> surfacesMeant(const Scene& scene, const std::string& name);

/// Every name of a material, an object and a surface, each once.
std::vector<std::string> knownNames(const Scene& scene);

/// The option flip for all if the surfaces called `names` are `all` that there are, else for each
/// of the first few: the cure of faces that are turned the wrong way.
std::string flipOption(const std::vector<std::string>& names, std::size_t all);

/// "no surface, material or object is called NAME; there are: ...", the most similar first.
std::string unknownNameText(const Scene& scene, const std::string& name);

}  // namespace radiosity
