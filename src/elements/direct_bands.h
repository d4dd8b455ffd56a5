// Direct light of more bands than those that elements were cut for: of each lamp by itself.
#pragma once

#include "radiosity/elements.h"

namespace radiosity {

/// Direct light by `materials`, whose bands may be others than those of `like`, at the vertices of
/// `like`: the direct field that computeElements() made of this mesh with these options and with
/// lights at the same places. The result is cut as that is, vertex by vertex; if the bands are its
/// bands divided among lamps, they sum to it but for the fine corrections of interpolation. Empty
/// (no elements) if emitters are so many that the direct light is not in that field. Throws
/// Cancelled.
ElementField directBands(const PatchMesh& mesh, const PatchMaterials& materials,
                         const ElementOptions& options, const ElementField& like,
                         Progress& progress);

}  // namespace radiosity
