// What the lamp of a scene without light most likely is.
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// A material or surface whose name says that it shines ("ceiling_lamp", "Light.003"); else the
/// ceiling, by name or as the surface with most area that faces down; else the first surface. A
/// name that --set takes; empty in a scene without surfaces.
std::string likelyLamp(const Scene& scene);

}  // namespace radiosity
