// The positions of the eyes of the gather method.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/gather.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// An eye looks along a unit normal. `own` is the polygon that it lies in, or kNone if it stands
/// off the surface.
struct Eye {
  Vec3 position{0.0};
  Vec3 normal{0.0};
  Index own = kNone;
  double angle = 0;    ///< of its hemicube about the normal
  bool looks = false;  ///< false: stands for no area
};

/// One eye a patch: the eyes of the form-factor matrix, with the same turns.
std::vector<Eye> patchEyes(const PatchMesh& mesh, const GatherOptions& options);

/// One eye a corner group.
std::vector<Eye> vertexEyes(const PatchMesh& mesh, const CornerGroups& groups,
                            const GatherOptions& options);

}  // namespace radiosity
