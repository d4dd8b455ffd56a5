// Pairs of elements made ready for sampling: the end chosen, cut to each other's front, and only
// the occluders kept that reach between their planes.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/exact/occluded/shadow_change.h"
#include "visibility/clipping/visible_part.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

struct OccludedPair;

/// A pair as it is sampled.
struct SampledPair {
  std::uint32_t pair;  ///< in the batch
  Index sampled;       ///< element that carries the points
  Index target;        ///< element that is looked at
  bool sampled_cut;    ///< reaches behind the target's plane
  bool target_cut;     ///< reaches behind the sampled element's plane
  /// How far shadows move across the target, in its sizes, from end to end of the sampled element:
  /// by the occluder for which this is most. Several times that past a thin occluder seen edge-on.
  float change;
  bool stood_on;   ///< EdgeDistances::isStoodOn(), by any of its blockers
  bool may_cross;  ///< an occluder's edge comes within the sampled element's radius of its centroid
  std::uint32_t blockers_begin, blockers_end;  ///< into PairPreparation::blockers
};

/// The end of a pair that carries the points. Of several occluders, the one whose shadow moves most
/// counts: a small patch beside one of them and a large one beside another are both far from their
/// nearest in their own sizes, but from the large one the small is seen or not in a step. (In the
/// curved scene at 1e-3 the rule halves the error that the distance to the nearest edge leaves.)
enum class SampledEnd {
  calmer,    ///< from end to end of it shadows move less across the other one: SampledPair::change
  restless,  ///< the other one
};

/// Distances of elements from occluders' edges, each kept once it is known, unless there are too
/// many, and from the planes of thin occluders.
class EdgeDistances {
 public:
  /// `few`: only some pairs are asked for, and a table would not pay.
  EdgeDistances(const ElementSet& elements, const OccluderSet& occluders, bool few = false);
  /// Square of the distance from the element's centroid to the occluder's nearest edge.
  double squared(Index element, Index occluder) const;

  /// True if the occluder is thin and its plane cuts the element or touches its border: the element
  /// sees it edge-on there and broadside from elsewhere. (A sheet that stands on another, 76
  /// patches, 1e-3: from a strip beside it a target was hidden, 6% of the pair, which fell between
  /// all points and the border.)
  bool seesEdgeOn(Index element, Index occluder) const;
  /// True if the occluder is thin and stands on the element, or hardly above it, with some of the
  /// element on either side: a target beyond it is seen from one side and hidden from the other, in
  /// a step. (Walls 1e-5 off their planes, 337 patches, 1e-3: one hid a target from a strip that
  /// was .4% of a patch, which fell between all points; .03% was stated.)
  bool isStoodOn(Index element, Index occluder) const;

 private:
  const ElementSet& elements_;
  const OccluderSet& occluders_;
  /// By occluder, then element; 0 where not known. Empty: computed each time.
  mutable std::vector<std::atomic<float>> table_;
  std::vector<Occluder::Plane> thin_;  ///< the middle of thin occluders; of others the normal is 0
};

/// Prepares one batch.
class PairPreparation {
 public:
  PairPreparation(const ElementSet& elements, const OccluderSet& occluders,
                  const EdgeDistances& distances);

  /// Fills `pairs`, sorted so that those sampled from the same points stand together. Pairs that
  /// have no part in front of each other are left out.
  void prepare(std::span<const OccludedPair> batch, std::span<const Index> occluder_list,
               SampledEnd end);

  std::vector<SampledPair> pairs;
  std::vector<Blocker> blockers;

 private:
  /// The position of an occluder relative to the planes of two facets.
  struct Between {
    std::uint32_t stamp = 0;
    bool blocks = false;
    bool cuts_first = false;   ///< reaches behind the first facet's plane
    bool cuts_second = false;  ///< reaches behind the second facet's plane
  };
  /// The place of a pair in the order of `pairs`.
  struct SortedPair {
    std::uint64_t key;
    std::uint32_t pair;
  };
  BothEnds addBlockers(const OccludedPair& given, std::span<const Index> occluder_list);
  BothEnds changes(const OccludedPair& given, std::uint32_t blockers_begin) const;
  void addPair(std::uint32_t number, const OccludedPair& given,
               std::span<const Index> occluder_list, SampledEnd end);
  void sortPairs();
  const Between& between(Index occluder, Index row_facet, Index column_facet);

  const ElementSet& elements_;
  const OccluderSet& occluders_;
  const EdgeDistances& distances_;
  std::vector<SortedPair> order_;
  std::vector<SampledPair> sorted_;
  ShadowChange change_;           ///< of the current pair
  std::vector<Between> between_;  ///< by occluder, of the current two facets
  std::uint32_t stamp_ = 0;
  Index row_facet_ = kNone;
  Index column_facet_ = kNone;
};

/// The part of an element in front of a facet's plane; corners within the coincidence of the plane
/// are on it. Three corners or more where one is in front.
std::vector<Vec3> partInFront(const ElementSet& elements, Index element, const Facet& facet);

}  // namespace radiosity
