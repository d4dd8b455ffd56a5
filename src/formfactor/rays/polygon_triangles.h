// Planar polygons as triangles, for a tracer that knows nothing else.
#pragma once

#include <array>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

/// Triangles (corners in ViewScene::vertices) that tile polygon p, holes left out: a constrained
/// Delaunay triangulation without added points, so as few triangles as there can be.
std::vector<std::array<std::uint32_t, 3>> polygonTriangles(const ViewScene& scene, Index p);

}  // namespace radiosity
