// Form factors by rays: their cost foreseen, and the whole matrix.
#pragma once

#include <cstddef>

#include "formfactor/method.h"
#include "formfactor/rays/ray_scene.h"

namespace radiosity {

struct RayEstimate {
  double rays = 0;       ///< all in all
  double tolerance = 0;  ///< reached by these rays, which may stop before the one aimed at
  double seconds = 0;
  double seconds_to_tolerance = 0;  ///< for the tolerance aimed at
  RowMemory memory;
  std::size_t matrix_bytes = 0;
};

/// Foreseen from some rows, which are cast to see how their error falls.
RayEstimate estimateRays(const RayScene& scene, const FormFactorOptions& options,
                         Progress& progress);

/// Casts rows in rounds. Each is continued until its expected error, merged with the other rows'
/// counts, is below options.toleranceOf(rays) times its norm, or times that of a usual row if that
/// is larger: the little that an open body sees of itself is not worth a thousand times the rays of
/// the rest. Of sources the sky counts in norms (FormFactorOptions::skyWeight()). Rows that are
/// known need no rays.
std::unique_ptr<PreparedMethod> prepareRays(const PatchMesh& mesh,
                                            const FormFactorOptions& options);

}  // namespace radiosity
