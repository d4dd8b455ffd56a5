// Scenes of which a part lies so far off that lengths of the rest are lost.
#pragma once

#include <optional>
#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Coincidence is a share of the whole scene's diagonal (`weld`). One forgotten object far away
/// makes it as long as a room's details. A note that names it and what it does, where the gap is
/// longer than a thousand times what lies on either side of it. Takes n log n time.
std::optional<Note> noteFarApart(const Scene& scene, double weld);

}  // namespace radiosity
