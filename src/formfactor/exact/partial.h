// Exchange areas of elements that see each other past something.
#pragma once

#include <span>

#include "formfactor/exact/elements.h"
#include "formfactor/exact/occluders.h"
#include "formfactor/exact/unoccluded.h"

namespace radiosity {

struct PartialCounts {
  std::size_t pairs = 0;
  std::size_t points = 0;      ///< point-to-element evaluations
  std::size_t subdivided = 0;  ///< pairs that needed more than the first rule
  std::size_t by_pixels = 0;   ///< too many occluders: visible fraction from an item buffer
  std::size_t hidden = 0;      ///< found to exchange nothing
  PartialCounts& operator+=(const PartialCounts& other);
};

struct PartialExchange {
  double exchange = 0;  ///< G, scaled units; 0 <= G <= the unoccluded G, by construction
  double error = 0;     ///< estimate of its absolute error, from embedded rules
};

struct PartialPair {
  Index row, column;                             ///< elements
  std::uint32_t occluders_begin, occluders_end;  ///< into the list given along
};

/// Unoccluded minus blocked, by exact clipping from points of the element farther from what blocks.
class PartialKernel {
 public:
  /// `tolerance`: absolute error aimed at for F, relative to the mean form factor 1/N (see
  /// FormFactorOptions). All are kept by reference.
  PartialKernel(const ElementSet& elements, const OccluderSet& occluders,
                const UnoccludedKernel& unoccluded, double tolerance, bool simd);

  /// out[k] for pairs[k]; a batch, so that pairs past one occluder share vectors. Thread-safe.
  void evaluate(std::span<const PartialPair> pairs, std::span<const Index> occluder_list,
                std::span<PartialExchange> out, PartialCounts& counts) const;

  /// The same from the other end: points on the element nearer to what blocks. For spot checks.
  PartialExchange evaluateFromOtherEnd(const PartialPair& pair,
                                       std::span<const Index> occluder_list) const;
};

}  // namespace radiosity
