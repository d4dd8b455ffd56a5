// Lists of lights in files.
#pragma once

#include <string>
#include <vector>

#include "radiosity/light.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Adds the lights of a JSON file: a list of objects, each with `kind`, a light's word, and what
/// the kind takes by the names that lightOf() knows; numbers, lists of numbers and texts:
///   [{"kind": "ies", "file": "panel.ldt", "at": [1, 2, 2.5], "flux": "900lm", "name": "desk"}]
/// `file` is sought from the folder of the list. A light with a name replaces the one of that name
/// in `lights`; one without gets a name that is neither there nor in the list, as addLight() makes
/// them. Errors: InputError naming file, light and cure, also for two lights of one name in the
/// list.
void addLights(const std::string& path, std::vector<Light>& lights);

}  // namespace radiosity
