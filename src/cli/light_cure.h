// Advice for a dark scene.
#pragma once

#include <string>

#include "cli/request.h"
#include "radiosity/scene.h"

namespace radiosity::cli {

/// Both cures, a lamp and the sky, the lamp as a command line to paste: the one that was typed with
/// --set for what is likeliest a lamp.
std::string lightCure(const Request& request, const Scene& scene);

/// A solution of B = 0, why, and both cures; where `bands` are not a scene's three, where the
/// file's own materials stand.
std::string darknessText(const Request& request, const Scene& scene, int bands);

}  // namespace radiosity::cli
