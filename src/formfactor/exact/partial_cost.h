// What pairs past occluders will take, before any is evaluated.
#pragma once

#include <span>

#include "formfactor/exact/elements.h"
#include "formfactor/exact/occluders.h"
#include "formfactor/exact/partial.h"

namespace radiosity {

struct PartialCost {
  double points = 0;    ///< PartialCounts::points
  double seconds = 0;   ///< of one core, at the rates of a usual machine
  double refining = 0;  ///< of the seconds, those that go with 1 / tolerance
  PartialCost& operator+=(const PartialCost& other);
  PartialCost operator*(double share) const;
};

/// Of PartialKernel with this tolerance, from how far shadows move across each pair: about. The
/// pairs' unoccluded values are not looked at, but guessed.
PartialCost partialCost(const ElementSet& elements, const OccluderSet& occluders,
                        std::span<const PartialPair> pairs, std::span<const Index> occluder_list,
                        double tolerance);

}  // namespace radiosity
