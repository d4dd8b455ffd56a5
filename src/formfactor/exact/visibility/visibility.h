// Classifies pairs of elements: unoccluded, hidden, or occluded, and by which occluders.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"
#include "visibility/shadows/shadow.h"
#include "visibility/shadows/tree.h"

namespace radiosity {

/// Counts of the classification, in pairs of elements (each unordered pair counted once).
struct VisibilityCounts {
  std::size_t no_exchange = 0;  ///< coplanar, back to back, below each other's horizon
  std::size_t unoccluded = 0;
  std::size_t hidden = 0;
  std::size_t occluded = 0;
  std::size_t facet_pairs = 0;              ///< looked at: ranges of rows and facets after theirs
  std::size_t facet_pairs_no_exchange = 0;  ///< settled by their planes alone
  std::size_t facet_pairs_unoccluded = 0;   ///< settled whole: no visibility code ran below them
  std::size_t shaft_tests = 0;              ///< of an occluder against the space between two shapes
  /// Pairs of elements that were settled, one way or another.
  std::size_t settled() const { return no_exchange + unoccluded + hidden + occluded; }
  VisibilityCounts& operator+=(const VisibilityCounts& other);
};

/// Pairs of walls are a large part of the work in few facets: among thousands of small facets a
/// stride would pass them by, or count them too often. So they are sampled apart.
enum class FacetSize { any, small, large };
/// True of facets of eight elements or more.
inline bool isLarge(const Facet& facet) { return facet.elements.size() >= 8; }

/// The pairs of some rows that a sample looks at, and its bound.
struct VisibilitySample {
  FacetSize size = FacetSize::any;
  std::size_t facet_stride = 1;  ///< over the open facets of this size after theirs,
  std::size_t first_facet = 0;   ///< from this one on
  std::size_t most_tests = std::numeric_limits<std::size_t>::max();  ///< then it stops,
  /// or at this later one, until it has settled kLeastSettled of the pairs left to the descent.
  std::size_t limit_of_tests = 0;
  static constexpr std::size_t kLeastSettled = 64;
};

/// The result of the first step of a sample, which looks at facets as a whole.
struct VisibilityOfFacets {
  VisibilityCounts settled;
  std::size_t left = 0;  ///< pairs of elements left to the descent
};

/// Receives the answers. `rows` are always inside the range asked for; `columns` come from one
/// facet.
class VisibilitySink {
 public:
  virtual ~VisibilitySink() = default;
  /// Called again and again while pairs are settled; may throw to end that.
  virtual void poll() const {}
  /// Nothing stands between any element of `rows` and any of `columns`. Some may still be below
  /// another's horizon, or cross its plane.
  virtual void unoccluded(ElementRange rows, ElementRange columns) = 0;
  /// Only these may stand between; ids ascending, into OccluderSet::occluders, one or more.
  virtual void occluded(Index row, Index column, std::span<const Index> occluders) = 0;
};

/// Classifies pairs of elements by descending two quadtrees at once. The list of occluders that may
/// stand between two clusters is handed down and thinned out on the way. A whole pair of clusters
/// is settled at once if nothing is in between, or one convex body hides all. Every answer but
/// `occluded` is proved; touching within the coincidence blocks nothing.
class Visibility {
 public:
  /// Both are kept by reference. `simd` false: the scalar target, the same answers.
  Visibility(const ElementSet& elements, const OccluderSet& occluders, bool simd = true);

  /// Classifies elements `rows` (of one facet that is not black; best a cluster's range) against
  /// the elements of their own facet that come after each (no exchange), and against all elements
  /// of the facets that come after it. Pairs without exchange and hidden ones are not reported, but
  /// counted. Thread-safe.
  void classify(ElementRange rows, VisibilitySink& sink, VisibilityCounts& counts) const;

  /// Classifies the same rows against some of the facets after theirs that are not hidden, to find
  /// out how much work that is; counts only pairs that it settles. Does nothing if the rows' facet
  /// is hidden (hidden_facets).
  VisibilityOfFacets classifySome(ElementRange rows, const VisibilitySample& sample,
                                  VisibilitySink& sink, VisibilityCounts& counts) const;
  /// The number of facets after that of `rows` from which classifySome() chooses; 0 if the rows'
  /// facet is hidden.
  std::size_t openFacetsAfter(ElementRange rows, FacetSize size = FacetSize::any) const;
  /// Pairs of `rows` with the elements of these.
  std::size_t openPairs(ElementRange rows, FacetSize size = FacetSize::any) const;

 private:
  friend class VisibilityDescent;

  const ElementSet& elements_;
  const OccluderSet& occluders_;
  OccluderTree tree_;
  VisibilityKernels kernels_;
  std::vector<ShapeCorners> shapes_;  ///< of clusters: bounds, or a leaf's element itself
  std::vector<Index> open_facets_;    ///< not hidden, ascending
  struct Open {
    std::size_t facets = 0;
    std::size_t elements = 0;
  };
  Open openAfter(ElementRange rows, FacetSize size) const;
  std::vector<Open> open_after_;         ///< open facets from one of them on
  std::vector<Open> large_after_;        ///< of these the large ones
  std::vector<std::vector<Index>> own_;  ///< of a facet: occluders that it lies on, ascending
};

}  // namespace radiosity
