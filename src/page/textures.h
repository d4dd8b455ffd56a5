// Textures as a page draws them: in 8 bits, no larger than a page can hold.
#pragma once

#include "page/container.h"
#include "radiosity/page.h"
#include "radiosity/scene.h"

namespace radiosity::page {

/// Texels of all textures of a page, at most; larger ones are halved.
inline constexpr std::size_t kMostTexels = std::size_t{4} << 20;

/// Adds `texture_T` and the header's `textures`; and to the header's materials, which
/// describeScene() wrote, which texture multiplies what. Those of surfaces of `mesh` alone; none if
/// the scene has no texture coordinates. Fills in the textures of `report`.
void addTextures(const Scene& scene, const PatchMesh& mesh, Container& container,
                 PageReport& report);

}  // namespace radiosity::page
