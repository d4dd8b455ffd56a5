// What each lamp gives to patches directly, by itself, for a page's sliders.
#pragma once

#include "page/container.h"
#include "page/nodes.h"
#include "radiosity/pipeline.h"

namespace radiosity::page {

struct Emitter {
  std::size_t material;
  double power;  ///< W, all bands
};
/// Materials that emit, the brightest first.
std::vector<Emitter> emittersOf(const Scene& scene, const PatchMesh& mesh,
                                const PatchMaterials& materials);

/// Adds the lights without a surface to the header and, patch by patch, the irradiance by each:
/// `light_L`.
void addLights(const PatchMaterials& materials, const PatchMesh& mesh, const FormFactors& factors,
               Progress& progress, Container& container);

/// Adds, patch by patch, the irradiance by all that emits of a material: `emitted_M`. The brightest
/// come first, as long as all fits into kMostEmittedBytes. Where form factors are between nodes,
/// these do not tell where on a node a lamp's light falls; and elements follow what is not direct.
void addEmitted(const Scene& scene, const PatchMesh& mesh, const PatchMaterials& materials,
                const ExchangeOperator& matrix, Container& container);

}  // namespace radiosity::page
