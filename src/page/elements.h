// The light of elements, as a page draws it and lights it anew.
#pragma once

#include "page/container.h"
#include "radiosity/pipeline.h"
#include "radiosity/render.h"

namespace radiosity::page {

inline constexpr std::size_t kMostElementLamps = 8;

/// Adds element_*: the triangles of the lit mesh of elements, those of writeLitGlb(), with the
/// irradiance of their corners and the share of it that each lamp gives directly; and the header's
/// `element_lamps`. Lamps are materials that emit, the brightest first, then lights that are
/// direct light as a whole; at most kMostElementLamps. Returns the number of triangles. If
/// `light` has no elements, the arrays are empty and the result is 0.
std::size_t addElements(Pipeline& pipeline, const SurfaceLight& light, double crease,
                        const Vec3& origin, Progress& progress, Container& container);

}  // namespace radiosity::page
