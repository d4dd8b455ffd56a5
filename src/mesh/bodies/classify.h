// Decides which sides of cells carry patches.
#pragma once

#include <vector>

#include "mesh/bodies/winding.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A sheet on a cell, with the sides from which it is seen.
struct VisibleCell {
  Index cell = kNone;
  Index sheet = kNone;
  bool above = false;
  bool below = false;
};

/// Decides by the space next to each side and by the other sheets in the same place:
/// - a side inside a closed outward solid, and in no cavity of it, is buried; if it faces the
///   solid's skin, the two are in contact and the skin is dropped, too (a block's bottom on a
///   floor);
/// - a side in a dark hollow (hollows.h) is buried;
/// - the sides of a two-sided closed component that see nothing are hidden;
/// - of sheets that face alike the emitter wins, else the smaller surface, else the first name;
/// - the far side of a two-sided sheet that lies on a one-sided one is in contact.
/// Adds to the surfaces' `buried` and `overlapped`, and to the notes.
std::vector<VisibleCell> classify(const Scene& scene, const InputFaces& input,
                                  const std::vector<Plane>& planes, const EdgeTable& edges,
                                  const Arrangement& arrangement, const std::vector<Sheet>& sheets,
                                  const Components& components, MeshReport& report,
                                  Progress& progress);

}  // namespace radiosity
