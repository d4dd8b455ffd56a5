// Which sides of which cells carry patches.
#pragma once

#include <vector>

#include "mesh/winding.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A sheet on a cell, as it is seen: from the side(s) that are kept.
struct VisibleCell {
  Index cell = kNone;
  Index sheet = kNone;
  bool above = false;
  bool below = false;
};

/// Decides by the space next to each side and by what else lies in the same place:
/// - a side inside a closed outward solid, and in no cavity of it, is buried; what faces that
///   solid's skin from inside it is in contact with the skin, and takes it along (a block's bottom
///   goes with the floor);
/// - the sides of a two-sided closed component that see nothing are hidden;
/// - of sheets that face alike the emitter wins, else the smaller surface, else the first name;
/// - the far side of a two-sided sheet that lies on a one-sided one is in contact.
/// Adds to the surfaces' `buried` and `overlapped`, and to the notes.
std::vector<VisibleCell> classify(const Scene& scene, const Arrangement& arrangement,
                                  const std::vector<Sheet>& sheets, const Components& components,
                                  const InputFaces& input, MeshReport& report);

}  // namespace radiosity
