// Whether any patch can see the sky. Both throw Cancelled.
#pragma once

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// True where the mesh proves it: every patch lies on the inside of a closed surface that faces
/// inwards (a room), or stands within one. False says nothing.
bool closedByTopology(const PatchMesh& mesh, Progress& progress);

/// True where no small hemicube (32 pixels) on any patch has a pixel of sky. Stops at the first
/// that has one.
bool closedByEye(const PatchMesh& mesh, Progress& progress);

}  // namespace radiosity
