// Exchange areas of elements that see each other past something.
#pragma once

#include <span>
#include <vector>

#include "formfactor/exact/occluded/pair_sampling.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

struct OccludedCounts {
  std::size_t pairs = 0;
  std::size_t points = 0;       ///< point-to-element evaluations
  std::size_t subdivided = 0;   ///< pairs that needed more than the first rule
  std::size_t hidden = 0;       ///< found to exchange nothing
  std::size_t cut_short = 0;    ///< kept with a larger error than accepted (kMostLooks)
  std::size_t by_segments = 0;  ///< clipping gave no number: exchangeBySegments() did
  std::size_t again = 0;        ///< evaluated again: see OccludedKernel
  OccludedCounts& operator+=(const OccludedCounts& other);
};

struct OccludedExchange {
  double exchange = 0;  ///< G, scaled units; 0 <= G <= the unoccluded G, by construction
  double error = 0;     ///< estimate of its absolute error, from embedded rules
  /// The share by which the points' sum of the unoccluded exchange misses its closed form: if
  /// large, the points do not resolve the elements' nearness.
  double unresolved = 0;
  bool cut_short = false;  ///< kept with a larger error than accepted: it took too much
  /// An element is too narrow for the precision of the clipping, or stood on
  /// (EdgeDistances::isStoodOn()).
  bool uncertain = false;
};

struct OccludedPair {
  Index row, column;                             ///< elements
  std::uint32_t occluders_begin, occluders_end;  ///< into the list given along
  double unoccluded;                             ///< G with nothing between (UnoccludedKernel)
};

/// Below this tolerance single precision is not enough: it knows the form factor to a target of
/// size h at distance r to 1e-6 r/h, and meshes of 20,000 patches have r/h near 100.
inline constexpr double kSinglePrecision = 2.5e-4;

/// Rechecks are made to this share of the tolerance, and to kStricterLoosest at most, so that they
/// are in double precision.
inline constexpr double kStricter = 1.0 / 8;
inline constexpr double kStricterLoosest = kSinglePrecision / 2;

/// Error of the pair's visible fraction that is accepted at a tolerance.
double allowedError(const ElementSet& elements, const OccludedPair& pair, double tolerance);

/// The exact unoccluded value times the visible fraction. The fraction is the quotient of two
/// quadratures over the points of one element, the one along which shadows move less across the
/// other: of the visible and of the whole form factor from the point to the other element, each in
/// closed form. So it lies in [0, 1], is exact where nothing or everything is hidden, and errors of
/// the quadrature from the elements' nearness cancel.
///
/// They do not cancel if the quadrature is all wrong: if a sliver touches a large element, none of
/// a few points on the latter lies where the exchange takes place. Pairs whose points miss the
/// unoccluded value by more than kPairResolved, or that need many points in single precision or
/// have an element too narrow for it or with something standing on it, are evaluated again: in
/// double precision, then, if that fails, from the other end; then, if the two disagree, more
/// strictly from both.
class OccludedKernel {
 public:
  /// `tolerance`: as FormFactorOptions::tolerance. Elements and occluders are kept by reference.
  OccludedKernel(const ElementSet& elements, const OccluderSet& occluders, double tolerance,
                 bool simd);

  /// out[k] for pairs[k]; a batch, so that pairs past one occluder share vectors: the more pairs
  /// the better, from some thousands on. Results do not depend on how pairs are batched.
  /// Thread-safe. Throws Cancelled where `progress`, if given, is cancelled. Values are finite
  /// whatever the geometry.
  void evaluate(std::span<const OccludedPair> pairs, std::span<const Index> occluder_list,
                std::span<OccludedExchange> out, OccludedCounts& counts,
                const Progress* progress = nullptr) const;

  /// The same in double precision and to a fraction of the tolerance (kStricter): the difference is
  /// nearly all of the error.
  void evaluateStrictly(std::span<const OccludedPair> pairs, std::span<const Index> occluder_list,
                        std::span<OccludedExchange> out, const Progress* progress = nullptr) const;

 private:
  /// Some pairs, and the place for their results.
  struct Batch {
    double tolerance;
    std::span<const OccludedPair> pairs;
    std::span<const Index> occluder_list;
    std::span<OccludedExchange> out;
    OccludedCounts& counts;
    const Progress* progress;
  };
  void evaluate(const Batch& batch) const;
  /// See kPairResolved.
  void evaluateAgain(const Batch& batch) const;
  std::vector<OccludedExchange> evaluateSome(const Batch& batch, std::span<const std::size_t> which,
                                             SampledEnd end, double tolerance) const;
  void settle(const Batch& batch, std::span<const std::size_t> apart) const;
  template <class T>
  void integrate(const ClipKernels<T>& kernels, const Batch& batch, SampledEnd end) const;

  const ElementSet& elements_;
  const OccluderSet& occluders_;
  EdgeDistances distances_;
  ClipKernelSet kernels_;
  double tolerance_;
};

}  // namespace radiosity
