// Finds parts of a scene that are so far away that details of the rest are lost.
#pragma once

#include <optional>
#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Coincidence is a share of the whole scene's diagonal (`weld`). A forgotten object far away makes
/// it as long as a room's details. Returns a note that names the object and its effect, if the gap
/// is longer than a thousand times the parts on both sides of it. O(n log n).
std::optional<Note> noteFarApart(const Scene& scene, double weld);

}  // namespace radiosity
