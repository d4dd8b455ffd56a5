// How many rays rows need for a tolerance of irradiance, and how far their nodes may be opened:
// tried on some rows, under lights of the scene's own.
#pragma once

#include <cmath>
#include <cstdint>

#include "formfactor/rays/ray_scene.h"
#include "matrix/patch_tree.h"
#include "radiosity/form_factors.h"

namespace radiosity {

struct CutPlan {
  std::uint32_t rays = 0;  ///< of a row, in each replicate
  double opening = 0;      ///< RowCutter
  /// Errors of the irradiance under trial lights, relative (L2, by area): of the rays, and of
  /// cutting their rows.
  double noise = 0;
  double bias = 0;
  double error() const { return std::hypot(noise, bias); }
  double entries = 0;   ///< of a row
  double seconds = 0;   ///< a row, of one thread by the clock
  bool is_lit = false;  ///< whether rows have seen anything that the trial lights shine on
};

/// For the tolerance of irradiance that the options have. Throws Cancelled.
CutPlan planCuts(const PatchMesh& mesh, const RayScene& scene, const PatchTree& tree,
                 const FormFactorOptions& options, Progress& progress);

}  // namespace radiosity
