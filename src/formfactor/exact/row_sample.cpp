#include "formfactor/exact/row_sample.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "formfactor/exact/recorded_pairs.h"

namespace radiosity {
namespace {

/// Of a task, ranges are taken until there are so many rows: what columns share is shared by rows.
constexpr std::size_t kLeastRows = 4;
/// Facets looked at, and tests made, for one range of rows.
constexpr std::size_t kMostFacets = 256;
constexpr std::size_t kMostLargeFacets = 6;
constexpr std::size_t kMostTests = 25'000;
/// Tests for each occluder, besides: what may come between two large facets is looked for among
/// all, and that settles nothing yet. At most so many.
constexpr std::size_t kTestsAnOccluder = 100;
constexpr std::size_t kMostTestsAtAll = 400'000;
/// Partial pairs of a task whose cost is guessed, evenly among all.
constexpr std::size_t kGuessedPairs = 48;
/// Pairs of a task that are clipped: as many as can be expected to take this, in so many batches
/// until they have taken it. (A few pairs, near to each other, carry half of the time or more: in
/// gazebo.obj of the lightmapper's examples one pair in 300 takes 38%. Many short batches meet
/// them.)
constexpr double kClipSeconds = 0.012;
/// And no pair more after so much in all places: at 1e-6 a single one past round bodies takes
/// tenths of a second.
constexpr double kClipSecondsAtAll = 0.8;
constexpr std::size_t kMostClipped = 1024;
constexpr std::size_t kBatches = 16;
/// Where the clock may stop things, they are taken in an order that jumps about, so that what is
/// left out is like what is not.
constexpr std::size_t kJump = 7;
static_assert(kBatches % kJump != 0);
/// Values in closed form that are computed.
constexpr std::size_t kMostValues = 1 << 13;

/// What all threads have clipped.
class ClipClock {
 public:
  void add(double seconds) { seconds_.fetch_add(seconds); }
  bool spent() const { return seconds_.load() >= kClipSecondsAtAll; }

 private:
  std::atomic<double> seconds_ = 0;
};

/// What was found in one place.
struct Piece {
  double weight = 0;  ///< pairs that it stands for
  double settled = 0;
  double unoccluded = 0;
  double partial = 0;
  double occluders = 0;
  double shaft_tests = 0;
  PartialCost cost;
  double rows = 0;
  double record_bytes = 0;
  double seconds_visibility = 0;
  double seconds_unoccluded = 0;
  double clip_seconds = 0;   ///< of the pairs that were clipped
  double clip_expected = 0;  ///< of the same, at the rates of a usual machine
  BothClocks taken;          ///< by all of it
};

double openPairs(const ExactScene& scene, std::span<const ElementRange> ranges, FacetSize size) {
  double pairs = 0;
  for (const ElementRange& range : ranges) pairs += double(scene.visibility.openPairs(range, size));
  return pairs;
}

/// Ranges from the middle of a task on, or its last ones.
std::span<const ElementRange> someRows(std::span<const ElementRange> task) {
  std::size_t first = task.size() / 2;
  std::size_t rows = 0;
  std::size_t end = first;
  while (end < task.size() && rows < kLeastRows) rows += task[end++].size();
  while (first > 0 && rows < kLeastRows) rows += task[--first].size();
  return task.subspan(first, end - first);
}

/// Partial pairs and blocks of some rows, and what finding them took.
void classify(const ExactScene& scene, std::span<const ElementRange> ranges, FacetSize size,
              std::size_t place, RecordedPairs& recorded, Piece& piece) {
  VisibilityCounts counts;
  const double start = processorSeconds();
  for (const ElementRange& range : ranges) {
    const std::size_t facets = scene.visibility.openFacetsAfter(range, size);
    VisibilitySample sample;
    sample.size = size;
    const std::size_t most = size == FacetSize::large ? kMostLargeFacets : kMostFacets;
    sample.facet_stride = std::max<std::size_t>(1, facets / most);
    sample.first_facet = place % sample.facet_stride;
    sample.most_tests =
        counts.shaft_tests +
        std::min(kMostTests + kTestsAnOccluder * scene.occluders.occluders.size(), kMostTestsAtAll);
    scene.visibility.classifySome(range, sample, recorded, counts);
    piece.rows += double(range.size());
  }
  piece.seconds_visibility = processorSeconds() - start;
  piece.settled = double(counts.no_exchange + counts.unoccluded + counts.hidden + counts.partial);
  for (const PairBlock& block : recorded.blocks) {
    piece.unoccluded += double(block.rows.size()) * double(block.columns.size());
  }
  piece.partial = double(recorded.partial_pairs.size());
  piece.occluders = double(recorded.occluder_list.size());
  piece.shaft_tests = double(counts.shaft_tests);
  piece.record_bytes =
      piece.partial * double(sizeof(PartialPair) + sizeof(PartialExchange) + sizeof(Index)) +
      piece.occluders * sizeof(Index) + double(recorded.blocks.size() * sizeof(PairBlock));
}

/// Values in closed form are asked for by whole chunks of columns: see RowAssembly.
void evaluateUnoccluded(const UnoccludedKernel& kernel, const RecordedPairs& recorded,
                        Piece& piece) {
  std::vector<double> values;
  UnoccludedCounts counts;
  double computed = 0;
  const std::size_t blocks = recorded.blocks.size();
  const double start = processorSeconds();
  // In an order that jumps about, so that what is left out is like what is not.
  const auto jump = std::size_t(std::max(1.0, std::round(0.618 * double(blocks))));
  for (std::size_t k = 0; k < blocks && computed < double(kMostValues); ++k) {
    const PairBlock& block = recorded.blocks[k * jump % blocks];
    const ElementRange rows{block.rows.first,
                            std::min(block.rows.end, block.rows.first + Index(kLeastRows))};
    const auto most = Index(kMostValues / rows.size());
    const ElementRange columns{block.columns.first,
                               std::min(block.columns.end, block.columns.first + most)};
    values.resize(std::size_t(rows.size()) * columns.size());
    kernel.block(rows, columns, values.data(), columns.size(), counts);
    computed += double(values.size());
  }
  const double seconds = processorSeconds() - start;
  if (computed > 0) {
    piece.seconds_unoccluded = seconds * (piece.unoccluded + piece.partial) / computed;
  }
}

/// Some pairs, evenly.
std::vector<PartialPair> evenly(const std::vector<PartialPair>& pairs, std::size_t most) {
  const std::size_t count = std::min(pairs.size(), most);
  std::vector<PartialPair> some;
  some.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    some.push_back(pairs[(2 * k + 1) * pairs.size() / (2 * count)]);
  }
  return some;
}

/// Some pairs in order of their columns, in batches of neighbours, which share work; batches evenly
/// from all.
std::vector<std::vector<PartialPair>> batchesOf(std::vector<PartialPair> pairs, std::size_t most) {
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto& a, const auto& b) { return a.column < b.column; });
  const std::size_t size = std::max<std::size_t>(std::min(pairs.size(), most) / kBatches, 1);
  const std::size_t count = std::min(kBatches, pairs.size() / size);
  std::vector<std::vector<PartialPair>> batches;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = (2 * k + 1) * (pairs.size() - size) / (2 * count);
    batches.emplace_back(pairs.begin() + std::ptrdiff_t(first),
                         pairs.begin() + std::ptrdiff_t(first + size));
  }
  return batches;
}

/// Clips pairs until that has taken its time, to see how much faster or slower than expected it is.
/// This alone stops by the clock: nothing but measured seconds comes of it.
void clip(const ExactScene& scene, const ExactKernels& kernels,
          const std::vector<std::vector<PartialPair>>& batches,
          std::span<const Index> occluder_list, double tolerance, ClipClock& clock, Piece& piece) {
  std::vector<PartialExchange> out;
  PartialCounts counts;
  for (std::size_t k = 0; k < kBatches && piece.clip_seconds < kClipSeconds && !clock.spent();
       ++k) {
    const std::size_t which = k * kJump % kBatches;
    if (which >= batches.size()) continue;
    std::vector<PartialPair> some = batches[which];
    piece.clip_expected +=
        partialCost(scene.elements, scene.occluders, some, occluder_list, tolerance).seconds;
    for (PartialPair& pair : some) {
      pair.unoccluded = kernels.unoccluded.pair(pair.row, pair.column);
    }
    std::erase_if(some, [](const PartialPair& pair) { return !(pair.unoccluded > 0); });
    out.resize(some.size());
    const double start = processorSeconds();
    kernels.partial.evaluate(some, occluder_list, out, counts);
    const double seconds = processorSeconds() - start;
    piece.clip_seconds += seconds;
    clock.add(seconds);
  }
}

/// What the partial pairs of some rows will take.
void costOfPairs(const ExactScene& scene, const ExactKernels& kernels,
                 const RecordedPairs& recorded, double tolerance, ClipClock& clock, Piece& piece) {
  const std::size_t all = recorded.partial_pairs.size();
  if (all == 0) return;
  const std::vector<PartialPair> guessed = evenly(recorded.partial_pairs, kGuessedPairs);
  const PartialCost sampled =
      partialCost(scene.elements, scene.occluders, guessed, recorded.occluder_list, tolerance);
  piece.cost = sampled * (double(all) / double(guessed.size()));
  const double of_one = sampled.seconds / double(guessed.size());
  const double affordable =
      std::clamp(kClipSeconds / std::max(of_one, 1e-9), 1.0, double(kMostClipped));
  clip(scene, kernels, batchesOf(recorded.partial_pairs, std::size_t(affordable)),
       recorded.occluder_list, tolerance, clock, piece);
}

Piece lookAt(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
             std::size_t place, std::span<const ElementRange> task, FacetSize size,
             ClipClock& clock) {
  const BothWatches watches;
  Piece piece;
  RecordedPairs recorded;
  classify(scene, someRows(task), size, place, recorded, piece);
  evaluateUnoccluded(kernels.unoccluded, recorded, piece);
  costOfPairs(scene, kernels, recorded, tolerance, clock, piece);
  piece.taken = watches.elapsed();
  return piece;
}

RowSample sumOf(const std::vector<Piece>& pieces, double task_rows) {
  RowSample sum;
  double looked_at = 0;  // pairs that the pieces with a result stand for
  double all = 0;
  double paced = 0;  // seconds of pieces of which pairs were clipped
  double unpaced = 0;
  BothClocks taken;
  for (const Piece& piece : pieces) {
    all += piece.weight;
    taken += piece.taken;
    if (!(piece.settled > 0)) continue;
    looked_at += piece.weight;
    const double share = piece.weight / piece.settled;
    sum.unoccluded += share * piece.unoccluded;
    sum.partial += share * piece.partial;
    sum.occluders += share * piece.occluders;
    sum.shaft_tests += share * piece.shaft_tests;
    sum.cost += piece.cost * share;
    sum.seconds_visibility += share * piece.seconds_visibility;
    sum.seconds_unoccluded += share * piece.seconds_unoccluded;
    if (piece.clip_expected > 0) {
      unpaced += share * piece.cost.seconds;
      paced += share * piece.cost.seconds * (piece.clip_seconds / piece.clip_expected);
    }
    const double task = task_rows / piece.rows * piece.record_bytes;
    sum.task_bytes = std::max(sum.task_bytes, std::size_t(task));
  }
  if (looked_at > 0 && looked_at < all) {
    const double share = all / looked_at;
    for (double* value : {&sum.unoccluded, &sum.partial, &sum.occluders, &sum.shaft_tests,
                          &sum.seconds_visibility, &sum.seconds_unoccluded}) {
      *value *= share;
    }
    sum.cost = sum.cost * share;
  }
  // Each piece at its own pace: where pairs are dear, fewer of them were clipped.
  const double pace = unpaced > 0 ? paced / unpaced : 1.0;
  sum.seconds_partial = pace * sum.cost.seconds;
  sum.busy = taken.ratio();
  return sum;
}

}  // namespace

RowSample sampleRows(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
                     Progress& progress) {
  const std::size_t tasks = scene.tasks.size();
  const std::size_t places = std::min(tasks, kSampleSteps);
  std::vector<Piece> pieces(2 * places);
  ClipClock clock;
  const std::size_t jump = places % kJump == 0 ? 1 : kJump;
  parallelFor(places, 1, [&](std::size_t n) {
    if (progress.cancelled()) return;
    const std::size_t k = n * jump % places;
    const std::size_t first = k * tasks / places;
    const std::size_t end = (k + 1) * tasks / places;
    const std::span<const ElementRange> task = scene.tasks[(first + end) / 2];
    for (const FacetSize size : {FacetSize::small, FacetSize::large}) {
      Piece piece = lookAt(scene, kernels, tolerance, k, task, size, clock);
      for (std::size_t t = first; t < end; ++t) {
        piece.weight += openPairs(scene, scene.tasks[t], size);
      }
      pieces[2 * k + std::size_t(size == FacetSize::large)] = piece;
    }
    progress.advance();
  });
  progress.check();
  const double rows = tasks > 0 ? double(scene.elements.patch_elements) / double(tasks) : 0;
  return sumOf(pieces, rows);
}

}  // namespace radiosity
