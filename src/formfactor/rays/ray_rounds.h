// Rows cast round after round, each until it is as good as asked for.
#pragma once

#include <functional>
#include <vector>

#include "formfactor/rays/ray_rows.h"
#include "radiosity/base.h"
#include "radiosity/form_factors.h"

namespace radiosity {

class Processes;
class RayScene;

/// Rays of the first round, in each replicate.
inline constexpr std::uint32_t kPilotRays = 512;
/// A row gets no more in each replicate: points then lie as close as their 24 bits can tell apart.
inline constexpr std::uint32_t kMostRays = 1u << 24;

/// How error squared falls with the number of rays, n^-this, where nothing better is known. (In
/// four dimensions scrambled nets reach n^-5/4 on what jumps, as visibility does: He & Wang, "On
/// the convergence rate of randomized quasi-Monte Carlo for discontinuous functions", SIAM J.
/// Numer. Anal. 53, 2015.)
inline constexpr double kUsualOrder = 1.25;

/// The least number of rays a replicate that is 2^k or 3 2^k and at least `rays`.
std::uint32_t roundedRays(double rays);

/// What rows are cast to.
struct RayAim {
  double tolerance = 0;  ///< error over norm
  /// Of all rows together; where the tolerance needs more, it is loosened for all alike.
  double most_rays = 0;

  explicit RayAim(const FormFactorOptions& options);
};

/// The smallest number from 1 on that raysAt(), the rays that a tolerance loosened so many times
/// needs, falling with it, brings to `most` or below; within a hundredth.
double loosening(double most, const std::function<double(double)>& raysAt);

/// All rows, by position. `known`: entries that are not estimated. Fills what the report says of
/// rays and rounds. `journal`: null where nothing is kept. `scratch`: where the rows' entries are
/// to be; null: in memory. `processes`: those that share the casting, whose others are in
/// castForOthers() (shared_rays.h); null: this one alone.
std::vector<RayRow> castRows(const RayScene& scene, const KnownEntries& known, const RayAim& aim,
                             RayReport& report, Progress& progress, RowJournal* journal,
                             ScratchMemory* scratch, Processes* processes);

}  // namespace radiosity
