// Advice for a dark scene.
#pragma once

#include <string>

#include "cli/request.h"
#include "radiosity/scene.h"

namespace radiosity::cli {

/// Both cures, a lamp and the sky. The lamp is a command line to paste: the one typed, with --set
/// for the most likely lamp. If there is a lamp and the mesh lost it, the cure for that.
std::string lightCure(const Request& request, const Scene& scene);

/// The reason for a solution of B = 0, and both cures; if `bands` are not a scene's three, the
/// place of the file's own materials.
std::string darknessText(const Request& request, const Scene& scene, int bands);

}  // namespace radiosity::cli
