// The visible fraction of a pair by segments: for pairs that cannot be clipped.
#pragma once

#include <span>

#include "formfactor/exact/occluded/occluded_pairs.h"

namespace radiosity {

/// Segments join 9 points of each element, in front of each other's planes. The exchange is the
/// share of them that no occluder meets, times the unoccluded exchange. A pair is hidden if
/// occluders meet all of them. The error is that of as many random segments, and at least that of
/// one. Finite for any geometry.
OccludedExchange exchangeBySegments(const ElementSet& elements, const OccluderSet& occluders,
                                    const OccludedPair& pair, std::span<const Index> occluder_list);

}  // namespace radiosity
