// Polygons that are nothing but faces of solids.
#pragma once

#include <span>

#include "base/geometry/box_tree.h"
#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

/// True if faces of the solids, together, cover the polygon: they block all that it blocks, right
/// behind or in front of it. The parts outside a face are cut into convex pieces and handed to the
/// next face. `places`: of the solids' boxes.
bool isCoveredBySolids(const OccluderPolygons& all, const OccluderPolygon& polygon,
                       std::span<const Occluder> solids, const BoxTree& places);

}  // namespace radiosity
