// Planar polygons over unchanged faces.
#pragma once

#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Normal, area and flatness of a face.
struct FaceShape {
  Vec3 normal{0.0};    ///< unit; 0 for a degenerate face
  double area = 0;     ///< 0 for a degenerate face
  bool planar = true;  ///< within the coincidence
};

/// Merges faces that share an edge (the same two vertices in opposite directions, and no third
/// face), lie in one plane within `coincidence` and belong to one surface. A polygon keeps every
/// vertex of its outline, so that it meets its neighbours vertex for vertex, like the faces.
/// Degenerate faces get no polygon, faces that are not planar one of their own. Fills mesh.polygon
/// and mesh.polygons (except index_in_surface), polygons in the order of their first faces. Throws
/// Cancelled.
void mergeFaces(const Scene& scene, std::span<const FaceShape> shapes, double coincidence,
                PatchMesh& mesh, Progress& progress);

}  // namespace radiosity
