// One descent through the clusters of one facet against all facets after it.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/exact/visibility/visibility.h"

namespace radiosity {

/// Works on one range of rows. The row's tree is descended once; at every row cluster the columns'
/// clusters not settled yet are looked at, down to about the row cluster's size, so that the
/// planes of each occluder's shadow are found once a row cluster.
class VisibilityDescent {
 public:
  VisibilityDescent(const Visibility& visibility, VisibilitySink& sink, VisibilityCounts& counts,
                    const VisibilitySample& sample = {});

  /// All pairs of the clusters' elements with elements of open facets after `facet`, which the
  /// cluster belongs to; of a sample, some of them.
  void run(Index facet, Index cluster);
  /// Counts over all runs.
  const VisibilityOfFacets& ofFacets() const { return of_facets_; }

 private:
  /// A column cluster that is still open, and the occluders that may stand between.
  struct Item {
    Index cluster;
    Index first_candidate, end_candidate;  ///< into candidates_
    bool column_above;                     ///< the row facet's plane, all of it
    bool row_above;                        ///< the column facet's plane, all of it
  };
  enum class Horizon : std::uint8_t { kBelow, kAcross, kAbove };

  /// The planes of an occluder's shadow of the row cluster at some depth, found when asked for.
  struct Level {
    std::vector<Index> slot;  ///< of an occluder, into shadows; kNone
    std::vector<Index> used;  ///< occluders with a slot
    std::vector<ShadowPlanes> shadows;
  };

  bool enough() const { return counts_.shaft_tests >= sample_.most_tests; }
  bool hasSettledSome() const {
    return counts_.settled() >= settled_before_ + VisibilitySample::kLeastSettled ||
           counts_.shaft_tests >= sample_.limit_of_tests;
  }
  void noteFacets(const VisibilityCounts& before);
  void addFacet(Index facet);
  void descend(Index row, std::size_t depth, std::size_t first_item, std::size_t end_item);
  void settle(Index row, std::size_t depth, Item item);
  void addCandidate(Index occluder, ShadowPlanes::Planes open) {
    candidates_.push_back(occluder);
    open_planes_.push_back(open);
  }
  void dropCandidates(std::size_t first) {
    candidates_.resize(first);
    open_planes_.resize(first);
  }
  /// False if the pair is settled; else the item's candidates are those that remain.
  bool thinOut(Index row, std::size_t depth, Item& item);
  bool meets(Index row, Item& item);
  ShadowPlanes& shadow(Index row, std::size_t depth, Index occluder);
  Horizon horizon(const Facet& facet, Index cluster) const;
  std::size_t pairs(Index row, Index column) const;

  const Visibility& visibility_;
  const ElementSet& elements_;
  VisibilitySink& sink_;
  VisibilityCounts& counts_;
  VisibilitySample sample_;  ///< most_tests: of all in counts_, earlier ones too
  VisibilityOfFacets of_facets_;
  std::size_t settled_before_ = 0;  ///< before the descent
  Index facet_ = 0;
  Index top_ = 0;
  std::vector<Item> items_;                        ///< a stack; each depth's at the end
  std::vector<Index> candidates_;                  ///< likewise
  std::vector<ShadowPlanes::Planes> open_planes_;  ///< of the row cluster's shadow, per candidate
  std::vector<Level> levels_;
};

}  // namespace radiosity
