// What each lamp gives to patches directly, by itself, for a page's sliders.
#pragma once

#include "page/container.h"
#include "page/nodes.h"
#include "radiosity/pipeline.h"

namespace radiosity::page {

/// Adds the lights without a surface to the header and, patch by patch, the irradiance by each:
/// `light_L`.
void addLights(const PatchMaterials& materials, const PatchMesh& mesh, const FormFactors& factors,
               Progress& progress, Container& container);

/// Where form factors are between nodes, these do not tell where on a node a lamp's light falls.
/// Adds, patch by patch, the irradiance by all that emits of a material: `emitted_M`. The brightest
/// come first, as long as all fits into kMostEmittedBytes; what others give is known by nodes.
void addEmitted(const Scene& scene, const PatchMesh& mesh, const PatchMaterials& materials,
                const ExchangeOperator& matrix, Container& container);

}  // namespace radiosity::page
