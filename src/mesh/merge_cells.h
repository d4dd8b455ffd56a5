// Visible cells put together into planar polygons.
#pragma once

#include <vector>

#include "mesh/arrangement.h"
#include "mesh/classify.h"
#include "mesh/complex.h"

namespace radiosity {

/// Sums of areas are only good to about this, relative: less is not said to have been moved.
inline constexpr double kAreaRounding = 1e-13;

/// Enters area that welding or straightening has moved off a surface (or onto it: negative).
void addMovedArea(SurfaceAreas& areas, double moved);

/// Joins cells of one surface with the same sides kept, across all edges, into polygons. Edges
/// inside a polygon stay as inner edges where a polygon of another plane meets it; all others go,
/// and so do vertices at which just two edges meet in a straight line.
/// Adds the report's `cuts` and `hidden_sides`; area that straightening moves (only ever within
/// coincidence) goes to the surfaces' `degenerate`.
/// Where rounding leaves a polygon without sound loops, `broken` gets its plane, and the complex is
/// not to be used.
CoarseComplex mergeCells(const Scene& scene, const InputFaces& input,
                         const std::vector<Plane>& planes, const std::vector<Sheet>& sheets,
                         const EdgeTable& edges, const Arrangement& arrangement,
                         const std::vector<VisibleCell>& visible, MeshReport& report,
                         std::vector<Index>& broken);

}  // namespace radiosity
