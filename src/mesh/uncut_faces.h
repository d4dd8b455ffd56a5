// Faces that could not be merged or cut with the others.
#pragma once

#include "mesh/complex.h"
#include "mesh/input_faces.h"

namespace radiosity {

/// Appends `input.uncut` to a complex as triangles on vertices of their own. What they touch is not
/// cut there, nor are they. Area that welding or a crossing of its own moves off a face goes to its
/// surface's `degenerate`.
void addUncut(const Scene& scene, const InputFaces& input, CoarseComplex& complex,
              MeshReport& report);

/// Says by surface which faces are not merged with their neighbours, and which are not cut.
void noteHandling(const InputFaces& input, MeshReport& report);

}  // namespace radiosity
