// Packs a pipeline's stages as the data of a page.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/page.h"

namespace radiosity::page {

/// The bytes of the container (src/page/README.md). `report` gets everything but the packed size.
/// Errors: those of writePage(), except those of the file.
std::vector<std::byte> pageData(Pipeline& pipeline, const SurfaceLight& light,
                                const PageOptions& options, Progress& progress, PageReport& report);

}  // namespace radiosity::page
