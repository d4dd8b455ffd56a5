// Names of lights that were not given one.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "radiosity/light.h"

namespace radiosity {

bool isCalled(std::span<const Light> lights, const std::string& name);
/// Of one more of a kind that a scene may have several of: "point", "point 2", ...
std::string nextName(const std::string& word,
                     const std::function<bool(const std::string&)>& is_taken);

}  // namespace radiosity
