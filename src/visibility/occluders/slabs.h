// The prism behind a convex polygon.
#pragma once

#include <optional>

#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

/// The prism behind a convex polygon down to the next polygon: where nobody can look behind the
/// polygon, all of it is inside the same body, like a board behind its underside. None if there is
/// no other polygon.
std::optional<Occluder> slabBehind(const OccluderPolygons& all, Index polygon);

}  // namespace radiosity
