#include "formfactor/exact/row_sample.h"

#include <algorithm>
#include <array>
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
constexpr std::size_t kMostFacets = 128;
constexpr std::size_t kMostLargeFacets = 4;
constexpr std::size_t kMostTests = 12'500;
/// Tests for each occluder, besides: what may come between two large facets is looked for among
/// all, and that settles nothing yet. At most so many.
constexpr std::size_t kTestsAnOccluder = 50;
constexpr std::size_t kMostTestsAtAll = 200'000;
/// Partial pairs of a task whose cost is guessed, evenly among all.
constexpr std::size_t kGuessedPairs = 48;
/// Pairs are clipped, to see how much longer they take than guessed, in up to so many rounds until
/// they have taken this share of all that is guessed, but no less and no more seconds than these.
/// (At 1e-6 a single pair past round bodies takes tenths of a second. A few pairs, near to each
/// other, carry half of the time or more: in gazebo.obj of the lightmapper's examples one pair in
/// 300 takes 38%. Many short batches meet them.)
constexpr std::size_t kRounds = 16;
constexpr double kClipShare = 0.02;
constexpr double kLeastClipSeconds = 0.25;
constexpr double kMostClipSeconds = 0.8;
/// About so many pairs a round, by what they stand for; from places and classes that stand for less
/// than this share, none; and no more in a batch than are guessed to take these seconds.
constexpr double kPairsARound = 256;
constexpr double kLeastShare = 1e-3;
constexpr double kBatchSeconds = 1e-3;
/// Batches are taken in an order that jumps about, so that what is left out when the time is up is
/// like what is not.
constexpr std::size_t kJump = 7;
static_assert(kRounds % kJump != 0);
/// Pairs with so many occluders or more are a class of their own: they are few, each takes up to a
/// thousand times as long as others, and most of that is not foreseen. (Six spheres' facets in a
/// box: one pair in ten has more, and these take nine tenths of the time.)
constexpr Index kManyOccluders = 32;
enum Clutter : std::size_t { few_occluders, many_occluders, clutter_classes };
/// Values in closed form that are computed.
constexpr std::size_t kMostValues = 1 << 13;

/// Partial pairs of one class, in one place.
struct ClippedPairs {
  std::vector<PartialPair> pairs;
  PartialCost cost;     ///< of all
  double seconds = 0;   ///< of those that were clipped
  double expected = 0;  ///< of the same, at the rates of a usual machine
};

/// What was found in one place.
struct Piece {
  double weight = 0;  ///< pairs that it stands for
  double settled = 0;
  double closely = 1;  ///< pairs for each that was settled in the descent
  double unoccluded = 0;
  double partial = 0;
  double occluders = 0;
  double shaft_tests = 0;
  std::array<ClippedPairs, clutter_classes> clipped;
  std::vector<Index> occluder_list;  ///< of the pairs
  double rows = 0;
  double record_bytes = 0;
  double seconds_visibility = 0;
  double seconds_unoccluded = 0;
  BothClocks taken;  ///< by all of it
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
  VisibilityOfFacets of_facets;
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
    const VisibilityOfFacets of_range =
        scene.visibility.classifySome(range, sample, recorded, counts);
    of_facets.settled += of_range.settled;
    of_facets.left += of_range.left;
    piece.rows += double(range.size());
  }
  const double seconds = processorSeconds() - start;
  // Where it stopped as it was, what was left of its facets is like what was settled of them.
  const VisibilityCounts& whole = of_facets.settled;
  const auto closely = double(counts.settled() - whole.settled());
  const double share = closely > 0 ? double(of_facets.left) / closely : 1.0;
  const auto all = [&](std::size_t settled, std::size_t settled_whole) {
    return double(settled_whole) + share * double(settled - settled_whole);
  };
  piece.settled = all(counts.settled(), whole.settled());
  piece.unoccluded = all(counts.unoccluded, whole.unoccluded);
  piece.shaft_tests = all(counts.shaft_tests, whole.shaft_tests);
  piece.closely = share;
  piece.partial = share * double(recorded.partial_pairs.size());
  piece.occluders = share * double(recorded.occluder_list.size());
  if (counts.shaft_tests > 0) {
    piece.seconds_visibility = seconds * piece.shaft_tests / double(counts.shaft_tests);
  }
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

/// A batch of pairs that are neighbours, and share work; batches evenly from all. Pairs are in
/// order of their columns.
std::span<const PartialPair> batchOf(std::span<const PartialPair> pairs, std::size_t size,
                                     std::size_t which) {
  if (which >= pairs.size() / size) return {};
  const std::size_t count = std::min(kRounds, pairs.size() / size);
  return pairs.subspan((2 * which + 1) * (pairs.size() - size) / (2 * count), size);
}

/// Clips a batch. Nothing but measured seconds comes of it.
void clip(const ExactScene& scene, const ExactKernels& kernels, std::span<const PartialPair> batch,
          std::span<const Index> occluder_list, double tolerance, ClippedPairs& clipped) {
  std::vector<PartialPair> some(batch.begin(), batch.end());
  clipped.expected +=
      partialCost(scene.elements, scene.occluders, some, occluder_list, tolerance).seconds;
  for (PartialPair& pair : some) {
    pair.unoccluded = kernels.unoccluded.pair(pair.row, pair.column);
  }
  std::erase_if(some, [](const PartialPair& pair) { return !(pair.unoccluded > 0); });
  std::vector<PartialExchange> out(some.size());
  PartialCounts counts;
  const double start = processorSeconds();
  kernels.partial.evaluate(some, occluder_list, out, counts);
  clipped.seconds += processorSeconds() - start;
}

/// What the partial pairs will take.
void costOfPairs(const ExactScene& scene, RecordedPairs recorded, double tolerance, Piece& piece) {
  for (const PartialPair& pair : recorded.partial_pairs) {
    const bool many = pair.occluders_end - pair.occluders_begin >= kManyOccluders;
    piece.clipped[many ? many_occluders : few_occluders].pairs.push_back(pair);
  }
  piece.occluder_list = std::move(recorded.occluder_list);
  for (ClippedPairs& of_class : piece.clipped) {
    if (of_class.pairs.empty()) continue;
    std::stable_sort(of_class.pairs.begin(), of_class.pairs.end(),
                     [](const auto& a, const auto& b) { return a.column < b.column; });
    const std::vector<PartialPair> guessed = evenly(of_class.pairs, kGuessedPairs);
    const PartialCost sampled =
        partialCost(scene.elements, scene.occluders, guessed, piece.occluder_list, tolerance);
    of_class.cost =
        sampled * (piece.closely * double(of_class.pairs.size()) / double(guessed.size()));
  }
}

/// `kernels`: null for counts alone.
Piece lookAt(const ExactScene& scene, const ExactKernels* kernels, double tolerance,
             std::size_t place, std::span<const ElementRange> task, FacetSize size) {
  const BothWatches watches;
  Piece piece;
  RecordedPairs recorded;
  classify(scene, someRows(task), size, place, recorded, piece);
  if (kernels != nullptr) evaluateUnoccluded(kernels->unoccluded, recorded, piece);
  costOfPairs(scene, std::move(recorded), tolerance, piece);
  piece.taken = watches.elapsed();
  return piece;
}

/// Seconds that the pairs of all tasks will take, as guessed, for which these stand.
double guessedSeconds(const Piece& piece, const ClippedPairs& of_class) {
  return piece.settled > 0 ? piece.weight / piece.settled * of_class.cost.seconds : 0.0;
}

void clipSome(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
              std::vector<Piece>& pieces, Progress& progress) {
  double all = 0;
  for (const Piece& piece : pieces) {
    for (const ClippedPairs& of_class : piece.clipped) all += guessedSeconds(piece, of_class);
  }
  const double most = std::clamp(kClipShare * all, kLeastClipSeconds, kMostClipSeconds);
  std::atomic<double> taken = 0;
  for (std::size_t round = 0; round < kRounds && taken.load() < most; ++round) {
    parallelFor(pieces.size(), 1, [&](std::size_t k) {
      Piece& piece = pieces[k];
      const BothWatches watches;
      for (ClippedPairs& of_class : piece.clipped) {
        const double share = guessedSeconds(piece, of_class) / all;
        if (progress.cancelled() || taken.load() >= most || !(share > kLeastShare)) continue;
        const double of_one =
            of_class.cost.seconds / (piece.closely * double(of_class.pairs.size()));
        const auto size =
            std::size_t(std::max(1.0, std::min(kPairsARound * share, kBatchSeconds / of_one)));
        const double before = of_class.seconds;
        clip(scene, kernels, batchOf(of_class.pairs, size, round * kJump % kRounds),
             piece.occluder_list, tolerance, of_class);
        taken.fetch_add(of_class.seconds - before);
      }
      piece.taken += watches.elapsed();
    });
  }
}

/// Of a class, over all pieces.
struct ClippedSum {
  PartialCost cost;
  double paced = 0;  ///< seconds of pieces of which pairs were clipped
  double unpaced = 0;

  /// Each piece at its own pace: where pairs are dear, fewer of them were clipped.
  void add(const ClippedPairs& clipped, double share) {
    cost += clipped.cost * share;
    if (!(clipped.expected > 0)) return;
    unpaced += share * clipped.cost.seconds;
    paced += share * clipped.cost.seconds * (clipped.seconds / clipped.expected);
  }
  double seconds() const { return cost.seconds * (unpaced > 0 ? paced / unpaced : 1.0); }
};

RowSample sumOf(const std::vector<Piece>& pieces, double task_rows) {
  RowSample sum;
  double looked_at = 0;  // pairs that the pieces with a result stand for
  double all = 0;
  std::array<ClippedSum, clutter_classes> clipped;
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
    sum.seconds_visibility += share * piece.seconds_visibility;
    sum.seconds_unoccluded += share * piece.seconds_unoccluded;
    for (std::size_t c = 0; c < clutter_classes; ++c) clipped[c].add(piece.clipped[c], share);
    const double task = task_rows / piece.rows * piece.record_bytes;
    sum.task_bytes = std::max(sum.task_bytes, std::size_t(task));
  }
  for (const ClippedSum& of_class : clipped) {
    sum.cost += of_class.cost;
    sum.seconds_partial += of_class.seconds();
  }
  if (looked_at > 0 && looked_at < all) {
    const double share = all / looked_at;
    for (double* value : {&sum.unoccluded, &sum.partial, &sum.occluders, &sum.shaft_tests,
                          &sum.seconds_visibility, &sum.seconds_unoccluded, &sum.seconds_partial}) {
      *value *= share;
    }
    sum.cost = sum.cost * share;
  }
  sum.busy = taken.ratio();
  return sum;
}

/// A task that stands for several in a row.
struct Place {
  std::size_t task = 0;
  FacetSize size = FacetSize::small;
  double weight = 0;  ///< open pairs of all these
};

/// Up to `most` places of about as many open pairs each, at the task in their middle. (By numbers
/// of tasks, a few of which pair walls with walls: what six spheres in a box take came out at 0.4.)
void addPlaces(const ExactScene& scene, FacetSize size, std::size_t most,
               std::vector<Place>& places) {
  const std::size_t tasks = scene.tasks.size();
  std::vector<double> until(tasks + 1, 0.0);  // open pairs of the tasks before
  for (std::size_t t = 0; t < tasks; ++t) {
    until[t + 1] = until[t] + openPairs(scene, scene.tasks[t], size);
  }
  std::size_t first = 0;
  for (std::size_t k = 1; k <= most && first < tasks; ++k) {
    const double quota = until[tasks] * double(k) / double(most);
    std::size_t end = first;
    while (end < tasks && (k == most || until[end + 1] <= quota)) ++end;
    // One that is larger than a place has the places that it reaches into.
    if (end == first && until[first] < quota) ++end;
    if (end == first) continue;
    const double middle = 0.5 * (until[first] + until[end]);
    const auto above = std::upper_bound(until.begin() + std::ptrdiff_t(first) + 1,
                                        until.begin() + std::ptrdiff_t(end), middle);
    if (until[end] > until[first]) {
      places.push_back({std::size_t(above - until.begin()) - 1, size, until[end] - until[first]});
    }
    first = end;
  }
}

/// `kernels`: null for counts alone.
RowSample sampleTasks(const ExactScene& scene, const ExactKernels* kernels, double tolerance,
                      std::size_t most_places, Progress& progress) {
  std::vector<Place> places;
  addPlaces(scene, FacetSize::small, most_places, places);
  addPlaces(scene, FacetSize::large, most_places, places);
  std::vector<Piece> pieces(places.size());
  parallelFor(places.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    pieces[k] = lookAt(scene, kernels, tolerance, k, scene.tasks[places[k].task], places[k].size);
    pieces[k].weight = places[k].weight;
    progress.advance();
  });
  progress.check();
  if (kernels != nullptr) clipSome(scene, *kernels, tolerance, pieces, progress);
  progress.check();
  const std::size_t tasks = scene.tasks.size();
  const double rows = tasks > 0 ? double(scene.elements.patch_elements) / double(tasks) : 0;
  return sumOf(pieces, rows);
}

}  // namespace

RowSample sampleRows(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
                     Progress& progress) {
  return sampleTasks(scene, &kernels, tolerance, kSampleSteps / 2, progress);
}

RowSample sampleRowsRoughly(const ExactScene& scene, double tolerance, Progress& progress) {
  return sampleTasks(scene, nullptr, tolerance, kRoughSampleSteps / 2, progress);
}

}  // namespace radiosity
