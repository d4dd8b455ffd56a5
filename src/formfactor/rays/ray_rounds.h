// Rows cast round after round, each until it is as good as asked for.
#pragma once

#include <functional>
#include <vector>

#include "formfactor/rays/ray_rows.h"
#include "formfactor/row_blocks.h"
#include "radiosity/base.h"
#include "radiosity/form_factors.h"

namespace radiosity {

class RayScene;

/// Rays of the first round, in each replicate.
inline constexpr std::uint32_t kPilotRays = 512;
/// Most rays of a row in each replicate: points then lie as close as 24 bits can tell apart.
inline constexpr std::uint32_t kMostRays = 1u << 24;

/// The least number of rays a replicate that is 4 to 7 times a power of 2 and at least `rays`,
/// which are 4 or more.
std::uint32_t roundedRays(double rays);

/// The most rays, a replicate, of each of so many rows that have seen next to nothing
/// (RowAccuracy::isUnknown()). They may want any number of rays, so that all of them together get
/// half as many as all rows get where no tolerance is asked for.
double mostOfUnknown(double rows);

/// The aim of casting rows.
struct RayAim {
  double tolerance = 0;  ///< error over norm
  /// Rays of all rows together; if the tolerance needs more, it is loosened for all rows alike.
  double most_rays = 0;
  double sky_weight = 0;     ///< the sky's part in norms: FormFactorOptions::skyWeight()
  double foreseen_rays = 0;  ///< all in all, for progress; 0: unknown

  explicit RayAim(const FormFactorOptions& options);
};

/// The smallest factor, 1 or more, that brings raysAt(factor) to `most` or below; within a
/// hundredth. raysAt(): the rays that a tolerance loosened by the factor needs, falling with it.
double loosening(double most, const std::function<double(double)>& raysAt);

/// Casts all rows, by position. `known`: entries that are not estimated. Fills the report's figures
/// of rays and rounds. Other processes are in CastBlocks meanwhile, round by round.
std::vector<RayRow> castRows(const RayScene& scene, const KnownEntries& known, const RayAim& aim,
                             RayReport& report, const RowRun& run);

}  // namespace radiosity
