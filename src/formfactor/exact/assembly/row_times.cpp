#include "formfactor/exact/assembly/row_times.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "base/parallel.h"

namespace radiosity {
namespace {

/// Pairs are clipped to time their work, in up to kRounds rounds, until a share of all foreseen
/// work is done: kMuchOfAll at first, falling to kClipShare when the seconds given are over. After
/// kMostTimes the seconds it ends in any case. Few pairs, near to each other, may carry half of the
/// time. Many short batches meet them.
constexpr std::size_t kRounds = 16;
constexpr double kClipShare = 0.02;
constexpr double kMuchOfAll = 0.08;
constexpr double kMostTimes = 3;
/// A round clips about kPairsARound pairs, shared out by foreseen work, none from places and
/// classes with less than kLeastShare of it; a batch has at most kBatchWork, about two
/// milliseconds. Pairs are dear in small batches, up to ten times in those of single pairs.
constexpr double kPairsARound = 4096;
constexpr double kLeastShare = 1e-3;
constexpr double kBatchWork = 2e5;
/// Batches are taken in an order that jumps about, so that those left out when the time is up are
/// like those taken.
constexpr std::size_t kJump = 7;
static_assert(kRounds % kJump != 0);
/// Closed forms computed in a place, and rows at a time.
constexpr std::size_t kMostValues = 1 << 13;
constexpr Index kValueRows = 4;

/// Occluded pairs of one class, in one place.
struct ClipTime {
  double seconds = 0;  ///< of those that were clipped
  double work = 0;     ///< foreseen, of the same
};

struct PlaceTime {
  std::array<ClipTime, clutter_classes> clipped;
  double unoccluded = 0;
  BothClocks taken;  ///< by all of it
};

/// Times closed forms by whole chunks of columns: see RowAssembly.
double unoccludedSeconds(const UnoccludedKernel& kernel, const SampledPlace& place) {
  std::vector<double> values;
  UnoccludedCounts counts;
  double computed = 0;
  const std::size_t blocks = place.blocks.size();
  const double start = processorSeconds();
  // An order that jumps about, so that blocks left out are like those taken.
  const auto jump = std::size_t(std::max(1.0, std::round(0.618 * double(blocks))));
  for (std::size_t k = 0; k < blocks && computed < double(kMostValues); ++k) {
    const PairBlock& block = place.blocks[k * jump % blocks];
    const ElementRange rows{block.rows.first,
                            std::min(block.rows.end, block.rows.first + kValueRows)};
    const auto most = Index(kMostValues / rows.size());
    const ElementRange columns{block.columns.first,
                               std::min(block.columns.end, block.columns.first + most)};
    values.resize(std::size_t(rows.size()) * columns.size());
    kernel.block(rows, columns, values.data(), columns.size(), counts);
    computed += double(values.size());
  }
  const double seconds = processorSeconds() - start;
  return computed > 0 ? seconds * (place.unoccluded + place.occluded) / computed : 0.0;
}

/// A batch of neighbouring pairs, which share work; batches lie evenly among all. Pairs are in
/// order of their columns.
std::span<const OccludedPair> batchOf(std::span<const OccludedPair> pairs, std::size_t size,
                                      std::size_t which) {
  if (which >= pairs.size() / size) return {};
  const std::size_t count = std::min(kRounds, pairs.size() / size);
  return pairs.subspan((2 * which + 1) * (pairs.size() - size) / (2 * count), size);
}

/// Clips a batch and measures the seconds; the values are dropped.
void clip(const ExactScene& scene, const ExactKernels& kernels, std::span<const OccludedPair> batch,
          std::span<const Index> occluder_list, double tolerance, ClipTime& clipped) {
  if (batch.empty()) return;
  std::vector<OccludedPair> some(batch.begin(), batch.end());
  clipped.work +=
      occludedCost(scene.elements, scene.occluders, some, occluder_list, tolerance).work;
  for (OccludedPair& pair : some) {
    pair.unoccluded = kernels.unoccluded.pair(pair.row, pair.column);
  }
  std::erase_if(some, [](const OccludedPair& pair) { return !(pair.unoccluded > 0); });
  std::vector<OccludedExchange> out(some.size());
  OccludedCounts counts;
  const double start = processorSeconds();
  kernels.occluded.evaluate(some, occluder_list, out, counts);
  clipped.seconds += processorSeconds() - start;
}

/// Work of the pairs of all tasks that these pairs stand for.
double foreseenWork(const SampledPlace& place, const SampledPairs& of_class) {
  return place.share() * of_class.cost.work;
}

class ClipRounds {
 public:
  ClipRounds(const ExactScene& scene, const ExactKernels& kernels, double tolerance, double seconds,
             const RowSample& sample, std::vector<PlaceTime>& times, Progress& progress)
      : scene_(scene),
        kernels_(kernels),
        tolerance_(tolerance),
        seconds_(seconds),
        sample_(sample),
        times_(times),
        progress_(progress) {
    for (const SampledPlace& place : sample.places) {
      for (const SampledPairs& of_class : place.classes) all_ += foreseenWork(place, of_class);
    }
  }

  void run() {
    for (std::size_t round = 0; round < kRounds && !isOver(); ++round) {
      const std::size_t which = round * kJump % kRounds;
      parallelFor(times_.size(), 1, [&](std::size_t k) {
        const BothWatches watches;
        for (std::size_t c = 0; c < clutter_classes; ++c) {
          clipSome(sample_.places[k], sample_.places[k].classes[c], which, times_[k].clipped[c]);
        }
        times_[k].taken += watches.elapsed();
      });
    }
  }

 private:
  bool isOver() const {
    const double taken = taken_.load();
    const double enough = std::lerp(kMuchOfAll, kClipShare, std::min(1.0, taken / seconds_));
    return progress_.cancelled() || taken >= kMostTimes * seconds_ || done_.load() >= enough * all_;
  }

  void clipSome(const SampledPlace& place, const SampledPairs& of_class, std::size_t which,
                ClipTime& clipped) {
    const double share = foreseenWork(place, of_class) / all_;
    if (isOver() || !(share > kLeastShare)) return;
    const auto pairs = double(of_class.pairs.size());
    const double of_one = of_class.cost.work / (place.closely * pairs);
    const double most = std::min({kPairsARound * share, kBatchWork / of_one, pairs});
    const ClipTime before = clipped;
    clip(scene_, kernels_, batchOf(of_class.pairs, std::size_t(std::max(1.0, most)), which),
         place.occluder_list, tolerance_, clipped);
    taken_.fetch_add(clipped.seconds - before.seconds);
    done_.fetch_add(clipped.work - before.work);
  }

  const ExactScene& scene_;
  const ExactKernels& kernels_;
  double tolerance_;
  double seconds_;
  const RowSample& sample_;
  std::vector<PlaceTime>& times_;
  Progress& progress_;
  double all_ = 0;  ///< work foreseen of all pairs
  std::atomic<double> taken_ = 0;
  std::atomic<double> done_ = 0;  ///< work, in the seconds taken
};

/// Seconds for each unit of work, over all that was clipped.
double overallPace(const std::vector<PlaceTime>& times) {
  ClipTime all;
  for (const PlaceTime& place : times) {
    for (const ClipTime& clipped : place.clipped) {
      all.seconds += clipped.seconds;
      all.work += clipped.work;
    }
  }
  return all.work > 0 ? all.seconds / all.work : 0.0;
}

/// Seconds of the pairs of a class. Each place counts at its own pace: where pairs are dear, fewer
/// of them were clipped.
double occludedSeconds(const RowSample& sample, const std::vector<PlaceTime>& times, Clutter of) {
  double work = 0;
  double paced = 0;  // of this, where pairs were clipped
  double seconds = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double of_place = foreseenWork(sample.places[k], sample.places[k].classes[of]);
    const ClipTime& clipped = times[k].clipped[of];
    work += of_place;
    if (!(clipped.work > 0)) continue;
    paced += of_place;
    seconds += of_place * (clipped.seconds / clipped.work);
  }
  return work * (paced > 0 ? seconds / paced : overallPace(times));
}

}  // namespace

RowTimes timeRows(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
                  double clip_seconds, const RowSample& sample, Progress& progress) {
  std::vector<PlaceTime> times(sample.places.size());
  parallelFor(times.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    const BothWatches watches;
    times[k].unoccluded = unoccludedSeconds(kernels.unoccluded, sample.places[k]);
    times[k].taken = watches.elapsed();
  });
  ClipRounds(scene, kernels, tolerance, clip_seconds, sample, times, progress).run();
  progress.check();
  RowTimes sum;
  BothClocks taken;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double share = sample.all_places * sample.places[k].share();
    sum.visibility += share * sample.places[k].seconds_visibility;
    sum.unoccluded += share * times[k].unoccluded;
    taken += sample.places[k].taken;
    taken += times[k].taken;
  }
  for (const Clutter of : {few_occluders, many_occluders}) {
    sum.occluded += sample.all_places * occludedSeconds(sample, times, of);
  }
  sum.busy = taken.ratio();
  return sum;
}

}  // namespace radiosity
