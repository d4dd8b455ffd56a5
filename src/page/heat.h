// Heat exchange on patches and surfaces.
#pragma once

#include "page/container.h"
#include "radiosity/pipeline.h"

namespace radiosity::page {

/// Adds heat_* by patches and, by surfaces, the header's `heat`.
void addHeat(Pipeline& pipeline, Container& container);

}  // namespace radiosity::page
