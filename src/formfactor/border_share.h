// How much of a patch lies along its border.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The share of the patch that lies within `width` of its border, in metres; 0 without an area.
inline double borderShare(const PatchMesh& mesh, std::size_t patch, double width) {
  const auto outline = mesh.outline(patch);
  double border = 0;
  for (std::size_t c = 0; c < outline.size(); ++c) {
    border +=
        glm::distance(mesh.vertices[outline[c]], mesh.vertices[outline[(c + 1) % outline.size()]]);
  }
  return mesh.area[patch] > 0 ? std::min(width * border / mesh.area[patch], 1.0) : 0.0;
}

}  // namespace radiosity
