#include "formfactor/exact/row_sample.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace radiosity {
namespace {

constexpr std::size_t kRoughSteps = kSampleSteps / 6;
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
              std::size_t place, RecordedPairs& recorded, SampledPlace& found) {
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
    found.rows += double(range.size());
  }
  const double seconds = processorSeconds() - start;
  // Where it stopped as it was, what was left of its facets is like what was settled of them.
  const VisibilityCounts& whole = of_facets.settled;
  const auto closely = double(counts.settled() - whole.settled());
  const double share = closely > 0 ? double(of_facets.left) / closely : 1.0;
  const auto all = [&](std::size_t settled, std::size_t settled_whole) {
    return double(settled_whole) + share * double(settled - settled_whole);
  };
  found.settled = all(counts.settled(), whole.settled());
  found.unoccluded = all(counts.unoccluded, whole.unoccluded);
  found.shaft_tests = all(counts.shaft_tests, whole.shaft_tests);
  found.closely = share;
  found.partial = share * double(recorded.partial_pairs.size());
  found.occluders = share * double(recorded.occluder_list.size());
  if (counts.shaft_tests > 0) {
    found.seconds_visibility = seconds * found.shaft_tests / double(counts.shaft_tests);
  }
  found.record_bytes =
      found.partial * double(sizeof(PartialPair) + sizeof(PartialExchange) + sizeof(Index)) +
      found.occluders * sizeof(Index) + double(recorded.blocks.size() * sizeof(PairBlock));
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

/// What the partial pairs will take.
void costOfPairs(const ExactScene& scene, RecordedPairs recorded, double tolerance,
                 SampledPlace& found) {
  for (const PartialPair& pair : recorded.partial_pairs) {
    const bool many = pair.occluders_end - pair.occluders_begin >= kManyOccluders;
    found.classes[many ? many_occluders : few_occluders].pairs.push_back(pair);
  }
  found.occluder_list = std::move(recorded.occluder_list);
  found.blocks = std::move(recorded.blocks);
  for (SampledPairs& of_class : found.classes) {
    if (of_class.pairs.empty()) continue;
    std::stable_sort(of_class.pairs.begin(), of_class.pairs.end(),
                     [](const auto& a, const auto& b) { return a.column < b.column; });
    const std::vector<PartialPair> guessed = evenly(of_class.pairs, kGuessedPairs);
    const PartialCost sampled =
        partialCost(scene.elements, scene.occluders, guessed, found.occluder_list, tolerance);
    of_class.cost =
        sampled * (found.closely * double(of_class.pairs.size()) / double(guessed.size()));
  }
}

SampledPlace lookAt(const ExactScene& scene, double tolerance, std::size_t place,
                    std::span<const ElementRange> task, FacetSize size) {
  const BothWatches watches;
  SampledPlace found;
  RecordedPairs recorded;
  classify(scene, someRows(task), size, place, recorded, found);
  costOfPairs(scene, std::move(recorded), tolerance, found);
  found.taken = watches.elapsed();
  return found;
}

void sumUp(double task_rows, RowSample& sum) {
  double looked_at = 0;  // pairs that the places with a result stand for
  double all = 0;
  for (const SampledPlace& place : sum.places) {
    all += place.weight;
    const double share = place.share();
    if (!(share > 0)) continue;
    looked_at += place.weight;
    sum.unoccluded += share * place.unoccluded;
    sum.partial += share * place.partial;
    sum.occluders += share * place.occluders;
    sum.shaft_tests += share * place.shaft_tests;
    for (const SampledPairs& of_class : place.classes) sum.cost += of_class.cost * share;
    const double task = task_rows / place.rows * place.record_bytes;
    sum.task_bytes = std::max(sum.task_bytes, std::size_t(task));
  }
  if (!(looked_at > 0)) return;
  sum.all_places = all / looked_at;
  for (double* value : {&sum.unoccluded, &sum.partial, &sum.occluders, &sum.shaft_tests}) {
    *value *= sum.all_places;
  }
  sum.cost = sum.cost * sum.all_places;
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

}  // namespace

RowSample sampleRows(const ExactScene& scene, double tolerance, SampleSize size,
                     Progress& progress) {
  const std::size_t most = (size == SampleSize::rough ? kRoughSteps : kSampleSteps) / 2;
  std::vector<Place> places;
  addPlaces(scene, FacetSize::small, most, places);
  addPlaces(scene, FacetSize::large, most, places);
  RowSample sample;
  sample.places.resize(places.size());
  progress.begin("planning", places.size());
  parallelFor(places.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    sample.places[k] = lookAt(scene, tolerance, k, scene.tasks[places[k].task], places[k].size);
    sample.places[k].weight = places[k].weight;
    progress.advance();
  });
  progress.check();
  progress.end();
  const std::size_t tasks = scene.tasks.size();
  sumUp(tasks > 0 ? double(scene.elements.patch_elements) / double(tasks) : 0, sample);
  return sample;
}

}  // namespace radiosity
