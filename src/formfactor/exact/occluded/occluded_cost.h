// What pairs past occluders will take, before any is evaluated.
#pragma once

#include <span>

#include "formfactor/exact/elements/elements.h"
#include "formfactor/exact/occluded/occluded_pairs.h"
#include "formfactor/exact/occluders/occluders.h"

namespace radiosity {

struct OccludedCost {
  double points = 0;    ///< OccludedCounts::points
  double seconds = 0;   ///< of one core, at the rates of a usual machine
  double refining = 0;  ///< of the seconds, those that go with 1 / tolerance
  OccludedCost& operator+=(const OccludedCost& other);
  OccludedCost operator*(double share) const;
};

/// Of OccludedKernel with this tolerance, from how far shadows move across each pair: about. The
/// pairs' unoccluded values are not looked at, but guessed.
OccludedCost occludedCost(const ElementSet& elements, const OccluderSet& occluders,
                          std::span<const OccludedPair> pairs, std::span<const Index> occluder_list,
                          double tolerance);

}  // namespace radiosity
