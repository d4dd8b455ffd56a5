// Helpers of loadScene().
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// The length of one mm, cm, m, in or ft in metres. Errors: InputError for any other unit.
double metresPer(const std::string& unit);

}  // namespace radiosity
