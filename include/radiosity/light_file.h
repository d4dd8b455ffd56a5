// Lists of lights in files.
#pragma once

#include <string>
#include <vector>

#include "radiosity/light.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The lights of a JSON file: a list of objects, each with `kind`, a light's word, and what the
/// kind takes by the names that lightOf() knows; numbers, lists of numbers and texts:
///   [{"kind": "ies", "file": "panel.ldt", "at": [1, 2, 2.5], "flux": "900lm", "name": "desk"}]
/// `file` is sought from the folder of the list. Errors: InputError naming file, light and cure.
std::vector<Light> readLights(const std::string& path);

}  // namespace radiosity
