// Handles faces that could not be merged or cut with the others.
#pragma once

#include "mesh/faces/input_faces.h"
#include "mesh/polygons/complex.h"

namespace radiosity {

/// Appends `input.uncut` to a complex as triangles with vertices of their own. Neither they nor the
/// faces that they touch are cut there. Area that a face loses by welding or by crossing itself is
/// added to its surface's `degenerate`.
void addUncut(const Scene& scene, const InputFaces& input, CoarseComplex& complex,
              MeshReport& report);

/// Notes, by surface, faces that are not merged with their neighbours and faces that are not cut.
void noteHandling(const InputFaces& input, MeshReport& report);

}  // namespace radiosity
