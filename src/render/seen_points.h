// What the middles of a picture's pixels show.
#pragma once

#include <limits>
#include <vector>

#include "radiosity/render.h"

namespace radiosity {

struct SeenPoint {
  Index patch = kNone;  ///< kNone: nothing
  bool back = false;    ///< of a one-sided patch, where backs are shown
  /// m, along the view direction.
  double depth = std::numeric_limits<double>::infinity();
};

/// width * height, top row first. Errors: as render().
std::vector<SeenPoint> middlesOfPixels(const PatchMesh& mesh, const Camera& camera,
                                       const RenderOptions& options);

}  // namespace radiosity
