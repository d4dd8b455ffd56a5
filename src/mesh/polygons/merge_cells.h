// Merges visible cells into planar polygons.
#pragma once

#include <vector>

#include "mesh/arrangement/arrangement.h"
#include "mesh/bodies/classify.h"
#include "mesh/polygons/complex.h"

namespace radiosity {

/// The relative accuracy of sums of areas: smaller moved areas are not reported.
inline constexpr double kAreaRounding = 1e-13;

/// Enters area that welding or straightening has taken from a surface (negative: added to it).
void addMovedArea(SurfaceAreas& areas, double moved);

/// Joins cells of one surface with the same sides kept, across all edges, into polygons. Edges
/// inside a polygon stay as inner edges if a polygon of another plane meets it there. All other
/// inner edges are removed, and so are vertices at which just two edges meet in a straight line.
/// Adds the report's `cuts` and `hidden_sides`. Area that straightening moves (always within
/// coincidence) is added to the surfaces' `degenerate`. If rounding leaves a polygon without sound
/// loops, `broken` gets its plane, and the complex must not be used.
CoarseComplex mergeCells(const Scene& scene, const InputFaces& input,
                         const std::vector<Plane>& planes, const std::vector<Sheet>& sheets,
                         const EdgeTable& edges, const Arrangement& arrangement,
                         const std::vector<VisibleCell>& visible, MeshReport& report,
                         std::vector<Index>& broken);

}  // namespace radiosity
