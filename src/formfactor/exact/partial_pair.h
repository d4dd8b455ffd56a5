// A pair of elements made ready for sampling: cut to each other's front, its end chosen.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/convex_polygon.h"
#include "formfactor/exact/elements.h"
#include "formfactor/exact/occluders.h"
#include "formfactor/exact/visible_part.h"

namespace radiosity {

struct SampledPair {
  Vec3 normal{0.0};               ///< of the sampled element's facet
  std::vector<Vec3> sampled;      ///< the part in front of the target's plane; empty: no exchange
  std::vector<Vec3> target;       ///< the part in front of the sampled element's plane
  std::vector<Blocker> blockers;  ///< those that reach between the planes
};

enum class SampledEnd { row, column };

/// The part of the pair between the two planes, sampled at the given end.
SampledPair samplePair(const ElementSet& elements, const OccluderSet& occluders, Index row,
                       Index column, std::span<const Index> blockers, SampledEnd end);

/// The end that is farther from the nearest edge of what blocks, in units of its own size: from
/// there shadows change least from point to point.
SampledEnd fartherEnd(const ElementSet& elements, const OccluderSet& occluders, Index row,
                      Index column, std::span<const Index> blockers);

}  // namespace radiosity
