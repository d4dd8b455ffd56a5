// Where the eyes of gathering stand: a page gathers with those of `radiosity gather`.
#pragma once

#include "page/container.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

/// eye_position (less `origin`), eye_normal, eye_axis: one eye a corner group, in the order of the
/// first shading vertices. Insets and turns are those of GatherOptions. Normal and axis are 0 for
/// an eye that stands for no area.
void addEyes(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container);

}  // namespace radiosity::page
