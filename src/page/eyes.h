// The eyes of gathering: a page uses those of `radiosity gather`.
#pragma once

#include "page/container.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

/// Adds eye_position (less `origin`), eye_normal and eye_axis: one eye for each corner group, in
/// the order of the first shading vertices. Insets and turns are those of GatherOptions. Normal and
/// axis are 0 for an eye that represents no area.
void addEyes(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container);

}  // namespace radiosity::page
