// The figures of a finished mesh for the report.
#pragma once

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Fills polygons, triangles, quads, smallest angle and its surface, longest edge and each
/// surface's `kept` (surfaces without an entry get one).
void fillFigures(const PatchMesh& mesh, MeshReport& report);

/// Counts the T-junctions of a mesh that should have none and notes their surfaces. `coincidence`
/// in metres.
void noteTJunctions(const PatchMesh& mesh, double coincidence, MeshReport& report);

/// A patch for every T-junction (see countTJunctions()): one with the edge that contains the
/// vertex.
std::vector<Index> patchesAtTJunctions(const PatchMesh& mesh, double tolerance);

}  // namespace radiosity
