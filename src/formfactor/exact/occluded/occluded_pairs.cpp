#include "formfactor/exact/occluded/occluded_pairs.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/adaptive_integrator.h"
#include "formfactor/exact/occluded/segment_fraction.h"

namespace radiosity {
namespace {

/// Of a pair's unoccluded exchange, points may miss this many times the error that is allowed, but
/// no less than kPairMissed and no more than kPairResolved. (Crossing sheets: points missed .6 and
/// .7% of two pairs, which were off by 1.4% and stated a tenth of that.)
constexpr double kMissedOfAllowed = 2;
constexpr double kPairMissed = 1e-3;

/// Share of what a pair may be off by below which it states no error. Rows that see next to nothing
/// rest on a few pairs, whose cells differ too little to tell what they miss. (Terrain, 1e-3: a row
/// that sees 1e-7 of others was off by 4% of that and stated .6%.)
constexpr double kPairLeast = 1e-4;

/// One pair evaluated from both ends. If both resolve it, the result of the smaller error; else
/// that of the end that resolves it better. If neither does, their difference adds to its error,
/// with a share by how badly each resolves the pair: a half if they are alike.
OccludedExchange betterOfBoth(const OccludedExchange& a, const OccludedExchange& b) {
  if (std::max(a.unresolved, b.unresolved) <= kPairResolved) return a.error <= b.error ? a : b;
  const double both = a.unresolved + b.unresolved;
  OccludedExchange better = a.unresolved <= b.unresolved ? a : b;
  if (better.unresolved > kPairResolved) {
    const double share = std::isfinite(both) ? better.unresolved / both : 0.5;
    better.error = std::hypot(better.error, share * (a.exchange - b.exchange));
  }
  return better;
}

/// Whether the results from both ends differ by more than their errors and what each end's points
/// missed explain: then one of them is likely to be wrong, and has not seen it.
bool disagree(const OccludedExchange& a, const OccludedExchange& b, double unoccluded) {
  const double explained =
      std::hypot(a.error, b.error) + (a.unresolved + b.unresolved) * unoccluded;
  return std::abs(a.exchange - b.exchange) > explained;
}

/// Whether the rounding of places, over the distance of a pair's elements, is more than the
/// accepted share of either's width. (A sliver at a wall, 3e-7 of the scene wide, 1e-3: it was seen
/// past the wall, 17% of its row, with 0.8% stated.)
template <class T>
bool isTooNarrow(const ElementSet& elements, const OccludedPair& pair, double allowed) {
  const auto width = [&](Index element) {
    return elements.area[element] / elements.radius[element];
  };
  const double distance =
      glm::distance(elements.centroid[pair.row], elements.centroid[pair.column]);
  const double narrower = std::min(width(pair.row), width(pair.column));
  return std::numeric_limits<T>::epsilon() * distance > allowed * narrower;
}

}  // namespace

double allowedError(const ElementSet& elements, const OccludedPair& pair, double tolerance) {
  const double area = std::min(elements.area[pair.row], elements.area[pair.column]);
  return kPairMost * tolerance * area / (double(elements.patch_elements) * pair.unoccluded);
}

OccludedCounts& OccludedCounts::operator+=(const OccludedCounts& other) {
  pairs += other.pairs;
  points += other.points;
  subdivided += other.subdivided;
  hidden += other.hidden;
  cut_short += other.cut_short;
  by_segments += other.by_segments;
  again += other.again;
  return *this;
}

OccludedKernel::OccludedKernel(const ElementSet& elements, const OccluderSet& occluders,
                               double tolerance, bool simd)
    : elements_(elements),
      occluders_(occluders),
      distances_(elements, occluders),
      kernels_(clipKernels(simd)),
      tolerance_(tolerance) {}

template <class T>
void OccludedKernel::integrate(const ClipKernels<T>& kernels, const Batch& batch,
                               SampledEnd end) const {
  const std::span<const OccludedPair> pairs = batch.pairs;
  const std::span<OccludedExchange> out = batch.out;
  std::fill(out.begin(), out.end(), OccludedExchange());
  PairPreparation ready(elements_, occluders_, distances_);
  ready.prepare(pairs, batch.occluder_list, end);
  const std::size_t most_looks = batch.tolerance >= kSinglePrecision
                                     ? kMostLooksOfAll
                                     : std::numeric_limits<std::size_t>::max();
  AdaptiveIntegrator<T> groups(elements_, kernels,
                               std::cbrt(kFarError / (kFarMost * batch.tolerance)), most_looks,
                               batch.progress);
  std::vector<VisibleFraction> fractions;
  const auto clipFacet = [&](const SampledPair& p) {
    return p.sampled_cut ? elements_.facet[p.target] : kNone;
  };
  for (std::size_t begin = 0; begin < ready.pairs.size();) {
    const SampledPair& first = ready.pairs[begin];
    std::size_t last = begin + 1;
    while (last < ready.pairs.size() && ready.pairs[last].sampled == first.sampled &&
           clipFacet(ready.pairs[last]) == clipFacet(first)) {
      ++last;
    }
    const auto group = std::span<const SampledPair>(ready.pairs).subspan(begin, last - begin);
    fractions.assign(group.size(), VisibleFraction());
    for (std::size_t k = 0; k < group.size(); ++k) {
      fractions[k].allowed = allowedError(elements_, pairs[group[k].pair], batch.tolerance);
    }
    groups.integrate(group, ready.blockers, fractions);
    for (std::size_t k = 0; k < group.size(); ++k) {
      const VisibleFraction& found = fractions[k];
      const OccludedPair& pair = pairs[group[k].pair];
      OccludedExchange& exchange = out[group[k].pair];
      const double seen = found.fraction();
      const double missed = std::abs(found.whole / pair.unoccluded - 1);
      // What points missed is seen or hidden as the rest is: twice seen (1 - seen) on average.
      const double of_missed = 2 * seen * (1 - seen) * missed;
      const double error = std::max(std::hypot(kPairMargin * found.error(), of_missed),
                                    std::min(kPairLeast * found.allowed, 1.0));
      exchange = {pair.unoccluded * seen, pair.unoccluded * error, missed, found.cut_short,
                  isTooNarrow<T>(elements_, pair, found.allowed) || group[k].stood_on};
      if (!std::isfinite(exchange.exchange) || !std::isfinite(exchange.error)) {
        exchange = exchangeBySegments(elements_, occluders_, pair, batch.occluder_list);
        ++batch.counts.by_segments;
      }
      batch.counts.points += found.points;
      batch.counts.subdivided += found.refined;
    }
    begin = last;
  }
}

void OccludedKernel::evaluate(std::span<const OccludedPair> pairs,
                              std::span<const Index> occluder_list, std::span<OccludedExchange> out,
                              OccludedCounts& counts, const Progress* progress) const {
  evaluate({tolerance_, pairs, occluder_list, out, counts, progress});
}

void OccludedKernel::evaluateStrictly(std::span<const OccludedPair> pairs,
                                      std::span<const Index> occluder_list,
                                      std::span<OccludedExchange> out,
                                      const Progress* progress) const {
  OccludedCounts uncounted;
  evaluate({std::min(kStricter * tolerance_, kStricterLoosest), pairs, occluder_list, out,
            uncounted, progress});
}

void OccludedKernel::evaluate(const Batch& batch) const {
  batch.counts.pairs += batch.pairs.size();
  if (batch.tolerance >= kSinglePrecision) {
    integrate(kernels_.single, batch, SampledEnd::calmer);
  } else {
    integrate(kernels_.exact, batch, SampledEnd::calmer);
  }
  evaluateAgain(batch);
  for (const OccludedExchange& found : batch.out) {
    batch.counts.hidden += found.exchange == 0;
    batch.counts.cut_short += found.cut_short;
  }
}

void OccludedKernel::evaluateAgain(const Batch& batch) const {
  std::vector<std::size_t> doubtful;
  const auto missedAllowed = [&](std::size_t k) {
    const double allowed = allowedError(elements_, batch.pairs[k], batch.tolerance);
    return std::max(kPairMissed, kMissedOfAllowed * allowed);
  };
  const auto find = [&] {
    doubtful.clear();
    for (std::size_t k = 0; k < batch.pairs.size(); ++k) {
      const OccludedExchange& x = batch.out[k];
      const bool resolved = x.unresolved <= std::min(kPairResolved, missedAllowed(k));
      if (!resolved || x.cut_short || x.uncertain) doubtful.push_back(k);
    }
  };
  find();
  // In double precision the pairs have been evaluated from this end already.
  const bool single = batch.tolerance >= kSinglePrecision;
  if (single) {
    const auto found = evaluateSome(batch, doubtful, SampledEnd::calmer, batch.tolerance);
    for (std::size_t m = 0; m < doubtful.size(); ++m) batch.out[doubtful[m]] = found[m];
  }
  batch.counts.again += doubtful.size();
  if (single) find();
  const auto others = evaluateSome(batch, doubtful, SampledEnd::restless, batch.tolerance);
  std::vector<std::size_t> apart;
  for (std::size_t m = 0; m < doubtful.size(); ++m) {
    OccludedExchange& x = batch.out[doubtful[m]];
    const std::size_t k = doubtful[m];
    const bool agree = !disagree(x, others[m], batch.pairs[k].unoccluded);
    x = betterOfBoth(x, others[m]);
    if (!agree || x.unresolved > missedAllowed(k)) apart.push_back(k);
  }
  settle(batch, apart);
}

/// Evaluates some pairs of a batch from one end in double precision.
std::vector<OccludedExchange> OccludedKernel::evaluateSome(const Batch& batch,
                                                           std::span<const std::size_t> which,
                                                           SampledEnd end, double tolerance) const {
  std::vector<OccludedPair> pairs;
  for (const std::size_t k : which) pairs.push_back(batch.pairs[k]);
  std::vector<OccludedExchange> found(pairs.size());
  if (pairs.empty()) return found;
  integrate(kernels_.exact,
            {tolerance, pairs, batch.occluder_list, found, batch.counts, batch.progress}, end);
  return found;
}

/// Evaluates pairs whose ends disagree more strictly. If they still do, they are off by as much.
void OccludedKernel::settle(const Batch& batch, std::span<const std::size_t> apart) const {
  const double strict = std::min(kStricter * batch.tolerance, kStricterLoosest);
  const auto a = evaluateSome(batch, apart, SampledEnd::calmer, strict);
  const auto b = evaluateSome(batch, apart, SampledEnd::restless, strict);
  for (std::size_t m = 0; m < apart.size(); ++m) {
    OccludedExchange& x = batch.out[apart[m]];
    x = betterOfBoth(a[m], b[m]);
    if (!disagree(a[m], b[m], batch.pairs[apart[m]].unoccluded)) continue;
    x.error = std::max(x.error, std::abs(a[m].exchange - b[m].exchange));
  }
}

}  // namespace radiosity
