// Which elements see each other wholly, not at all, or past what.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "formfactor/exact/elements.h"
#include "formfactor/exact/occluders.h"

namespace radiosity {

/// What classification did, in pairs of elements (each unordered pair counted once).
struct VisibilityCounts {
  std::size_t no_exchange = 0;  ///< coplanar, back to back, below each other's horizon
  std::size_t unoccluded = 0;
  std::size_t hidden = 0;
  std::size_t partial = 0;
  std::size_t facet_pairs = 0;              ///< looked at
  std::size_t facet_pairs_no_exchange = 0;  ///< settled by their planes alone
  std::size_t facet_pairs_unoccluded = 0;   ///< settled whole: no visibility code ran below them
  std::size_t shaft_tests = 0;
  VisibilityCounts& operator+=(const VisibilityCounts& other);
};

/// Receives the answers. `rows` are always inside the range asked for; `columns` come from one
/// facet.
class VisibilitySink {
 public:
  virtual ~VisibilitySink() = default;
  /// Nothing stands between any element of `rows` and any of `columns`. Some may still be below
  /// another's horizon, or cross its plane.
  virtual void unoccluded(ElementRange rows, ElementRange columns) = 0;
  /// At least these may stand between; ids ascending, into OccluderSet::occluders, one or more.
  virtual void partial(Index row, Index column, std::span<const Index> occluders) = 0;
};

class Visibility {
 public:
  /// Both are kept by reference.
  Visibility(const ElementSet& elements, const OccluderSet& occluders);

  /// Classifies elements `rows` (of one facet, a cluster's range) against all elements of facets
  /// that come after that facet. Pairs without exchange and hidden ones are not reported.
  /// Thread-safe.
  void classify(ElementRange rows, VisibilitySink& sink, VisibilityCounts& counts) const;
};

}  // namespace radiosity
