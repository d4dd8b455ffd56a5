// Helpers of loadScene().
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Length of one mm, cm, m, in or ft in metres. InputError for any other unit.
double metresPer(const std::string& unit);

}  // namespace radiosity
