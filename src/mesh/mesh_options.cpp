#include <fmt/format.h>

#include <cmath>

#include "mesh/cells/edge_cuts.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

void MeshOptions::validate() const {
  if (patches < 1 || double(patches) > kMostPatches) {
    throw InputError(
        fmt::format("patches: {} is out of range; 1 to {:.0f}", patches, kMostPatches));
  }
  if (!(max_edge >= 0) || !std::isfinite(max_edge)) {
    throw InputError(fmt::format(
        "max_edge: {:g} m is out of range; more than 0, or 0 to derive it from patches", max_edge));
  }
  if (!(weld >= 0 && weld <= 1e-2)) {
    throw InputError(fmt::format(
        "weld: {:g} is out of range; a fraction of the scene's diagonal, 0 to 0.01", weld));
  }
}

}  // namespace radiosity
