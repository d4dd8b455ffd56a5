// Cost of occluded pairs, foreseen before any is evaluated.
#pragma once

#include <span>

#include "formfactor/exact/occluded/occluded_pairs.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

struct OccludedCost {
  double points = 0;    ///< OccludedCounts::points
  double work = 0;      ///< see foreseen_work.h
  double refining = 0;  ///< the part of the work that goes with 1 / tolerance
  OccludedCost& operator+=(const OccludedCost& other);
  OccludedCost operator*(double share) const;
};

/// The approximate cost of OccludedKernel with this tolerance, from how far shadows move across
/// each pair. The pairs' unoccluded values are guessed. (Pairs of the closed Cornell box, two
/// rooms, the cluttered and the curved scene at tolerances from 1e-1 to 1e-4: where the foreseen
/// error is from a tenth of the accepted one to 200 times it, counted points are within a factor of
/// 1.5.)
OccludedCost occludedCost(const ElementSet& elements, const OccluderSet& occluders,
                          std::span<const OccludedPair> pairs, std::span<const Index> occluder_list,
                          double tolerance);

}  // namespace radiosity
