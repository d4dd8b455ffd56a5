#include "formfactor/exact/assembly/row_sample.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"

namespace radiosity {
namespace {

/// A sample takes ranges of a task until it has this many rows: rows share work on their columns.
constexpr std::size_t kLeastRows = 4;
/// The most facets looked at for one range of rows.
constexpr std::size_t kMostFacets = 128;
constexpr std::size_t kMostLargeFacets = 16;
/// The most tests made in a place: for each range of rows; for each occluder, since testing all
/// against the space between two large facets settles nothing yet; and at all, where these have not
/// settled any of the pairs behind occluders. (A forest of columns: none of the pairs between them
/// was settled, which took a hundred times the rest.)
constexpr std::size_t kTestsARange = 12'500;
constexpr std::size_t kTestsAnOccluder = 50;
constexpr std::size_t kMostTests = 200'000;
/// Occluded pairs of a task whose cost is guessed, evenly among all.
constexpr std::size_t kGuessedPairs = 48;

/// Finds occluded pairs and blocks of some rows, and measures what that takes.
void classify(const ExactScene& scene, std::span<const ElementRange> ranges, FacetSize size,
              std::size_t place, RecordedPairs& recorded, SampledPlace& found) {
  VisibilityCounts counts;
  VisibilityOfFacets of_facets;
  const double start = processorSeconds();
  const std::size_t most_tests =
      std::min(kTestsARange * ranges.size() + kTestsAnOccluder * scene.occluders.occluders.size(),
               kMostTests);
  for (const ElementRange& range : ranges) {
    const std::size_t facets = scene.visibility.openFacetsAfter(range, size);
    VisibilitySample sample;
    sample.size = size;
    const std::size_t most = size == FacetSize::large ? kMostLargeFacets : kMostFacets;
    sample.facet_stride = std::max<std::size_t>(1, facets / most);
    sample.first_facet = place % sample.facet_stride;
    sample.most_tests = counts.shaft_tests + most_tests / ranges.size();
    sample.limit_of_tests = counts.shaft_tests + kMostTests / ranges.size();
    const VisibilityOfFacets of_range =
        scene.visibility.classifySome(range, sample, recorded, counts);
    of_facets.settled += of_range.settled;
    of_facets.left += of_range.left;
    found.rows += double(range.size());
  }
  const double seconds = processorSeconds() - start;
  // If it stopped early, the rest of its facets is taken to be like the settled part.
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
  found.occluded = share * double(recorded.occluded_pairs.size());
  found.occluders = share * double(recorded.occluder_list.size());
  if (counts.shaft_tests > 0) {
    found.seconds_visibility = seconds * found.shaft_tests / double(counts.shaft_tests);
  }
  found.record_bytes =
      found.occluded * double(sizeof(OccludedPair) + sizeof(OccludedExchange) + sizeof(Index)) +
      found.occluders * sizeof(Index) + double(recorded.blocks.size() * sizeof(PairBlock));
}

/// Some pairs, evenly.
std::vector<OccludedPair> evenly(const std::vector<OccludedPair>& pairs, std::size_t most) {
  const std::size_t count = std::min(pairs.size(), most);
  std::vector<OccludedPair> some;
  some.reserve(count);
  for (std::size_t k = 0; k < count; ++k) {
    some.push_back(pairs[(2 * k + 1) * pairs.size() / (2 * count)]);
  }
  return some;
}

/// Sorts occluded pairs by class and column.
void takePairs(RecordedPairs recorded, SampledPlace& found) {
  for (const OccludedPair& pair : recorded.occluded_pairs) {
    const bool many = pair.occluders_end - pair.occluders_begin >= kManyOccluders;
    found.classes[many ? many_occluders : few_occluders].pairs.push_back(pair);
  }
  for (SampledPairs& of_class : found.classes) {
    std::stable_sort(of_class.pairs.begin(), of_class.pairs.end(),
                     [](const auto& a, const auto& b) { return a.column < b.column; });
  }
  found.occluder_list = std::move(recorded.occluder_list);
  found.blocks = std::move(recorded.blocks);
}

void foreseeCost(const ExactScene& scene, double tolerance, SampledPlace& place) {
  for (SampledPairs& of_class : place.classes) {
    if (of_class.pairs.empty()) continue;
    const std::vector<OccludedPair> guessed = evenly(of_class.pairs, kGuessedPairs);
    const OccludedCost sampled =
        occludedCost(scene.elements, scene.occluders, guessed, place.occluder_list, tolerance);
    of_class.cost =
        sampled * (place.closely * double(of_class.pairs.size()) / double(guessed.size()));
  }
}

/// Ranges of rows, taken for themselves and their neighbours, with facets of one size.
struct SampledRanges {
  std::span<const ElementRange> rows;
  FacetSize size = FacetSize::small;
  double weight = 0;  ///< open pairs of all these
};

SampledPlace lookAt(const ExactScene& scene, std::size_t number, const SampledRanges& place) {
  const BothWatches watches;
  SampledPlace found;
  found.weight = place.weight;
  RecordedPairs recorded;
  classify(scene, place.rows, place.size, number, recorded, found);
  takePairs(std::move(recorded), found);
  found.taken = watches.elapsed();
  return found;
}

void sumUp(double task_rows, RowSample& sum) {
  sum.unoccluded = sum.occluded = sum.occluders = sum.shaft_tests = 0;
  double looked_at = 0;  // pairs that the places with a result stand for
  double all = 0;
  for (const SampledPlace& place : sum.places) {
    all += place.weight;
    const double share = place.share();
    if (!(share > 0)) continue;
    looked_at += place.weight;
    sum.unoccluded += share * place.unoccluded;
    sum.occluded += share * place.occluded;
    sum.occluders += share * place.occluders;
    sum.shaft_tests += share * place.shaft_tests;
    const double task = task_rows / place.rows * place.record_bytes;
    sum.task_bytes = std::max(sum.task_bytes, std::size_t(task));
  }
  if (!(looked_at > 0)) return;
  sum.all_places = all / looked_at;
  for (double* value : {&sum.unoccluded, &sum.occluded, &sum.occluders, &sum.shaft_tests}) {
    *value *= sum.all_places;
  }
}

/// All ranges of rows of the first tasks, of large facets or of small ones.
std::vector<ElementRange> rangesOf(const ExactScene& scene, std::size_t tasks, FacetSize size) {
  std::vector<ElementRange> ranges;
  for (std::size_t t = 0; t < tasks; ++t) {
    for (const ElementRange& range : scene.tasks[t]) {
      const Facet& facet = scene.elements.facets[scene.elements.facet[range.first]];
      if (isLarge(facet) == (size == FacetSize::large)) ranges.push_back(range);
    }
  }
  return ranges;
}

/// Ranges from one on, or the last ones, until they have kLeastRows.
std::span<const ElementRange> rowsFrom(std::span<const ElementRange> ranges, std::size_t first) {
  std::size_t rows = 0;
  std::size_t end = first;
  while (end < ranges.size() && rows < kLeastRows) rows += ranges[end++].size();
  while (first > 0 && rows < kLeastRows) rows += ranges[--first].size();
  return ranges.subspan(first, end - first);
}

/// Adds up to `most` places with about as many open pairs each, at the range in their middle.
void addPlaces(const ExactScene& scene, std::span<const ElementRange> ranges, FacetSize size,
               std::size_t most, std::vector<SampledRanges>& places) {
  std::vector<double> until{0.0};  // open pairs of the ranges before
  until.reserve(ranges.size() + 1);
  for (const ElementRange& range : ranges) {
    until.push_back(until.back() + double(scene.visibility.openPairs(range, size)));
  }
  std::size_t first = 0;
  for (std::size_t k = 1; k <= most && first < ranges.size(); ++k) {
    const double quota = until.back() * double(k) / double(most);
    std::size_t end = first;
    while (end < ranges.size() && (k == most || until[end + 1] <= quota)) ++end;
    // A range larger than a place takes up all places that it reaches into.
    if (end == first && until[first] < quota) ++end;
    if (!(until[end] > until[first])) continue;
    const double middle = 0.5 * (until[first] + until[end]);
    const auto above = std::upper_bound(until.begin() + std::ptrdiff_t(first) + 1,
                                        until.begin() + std::ptrdiff_t(end), middle);
    const auto at = std::size_t(above - until.begin()) - 1;
    places.push_back({rowsFrom(ranges.first(end), at), size, until[end] - until[first]});
    first = end;
  }
}

}  // namespace

void sampleRows(const ExactScene& scene, double tolerance, RowSample& sample, Progress& progress) {
  samplePairs(scene, scene.tasks.size(), kSampleSteps, sample, progress);
  foreseeCost(scene, tolerance, sample);
}

void foreseeCost(const ExactScene& scene, double tolerance, RowSample& sample) {
  parallelFor(sample.places.size(), 1,
              [&](std::size_t k) { foreseeCost(scene, tolerance, sample.places[k]); });
  sample.cost = {};
  for (const SampledPlace& place : sample.places) {
    const double share = sample.all_places * place.share();
    for (const SampledPairs& of_class : place.classes) sample.cost += of_class.cost * share;
  }
}

void samplePairs(const ExactScene& scene, std::size_t tasks, std::size_t steps, RowSample& sample,
                 Progress& progress) {
  // Pairs of two walls, and of a wall and a small facet, are classes of their own: few of the rows,
  // and much of the work.
  const std::array<std::vector<ElementRange>, 2> ranges = {
      rangesOf(scene, tasks, FacetSize::large), rangesOf(scene, tasks, FacetSize::small)};
  std::vector<SampledRanges> places;
  const std::size_t row_classes = (ranges[0].empty() ? 0U : 1U) + (ranges[1].empty() ? 0U : 1U);
  for (const std::vector<ElementRange>& rows : ranges) {
    for (const FacetSize columns : {FacetSize::large, FacetSize::small}) {
      addPlaces(scene, rows, columns, steps / (2 * std::max<std::size_t>(row_classes, 1)), places);
    }
  }
  sample.places.resize(places.size());
  progress.begin("planning", places.size());
  parallelFor(places.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    if (sample.places[k].weight != places[k].weight) {
      sample.places[k] = lookAt(scene, k, places[k]);
    }
    progress.advance();
  });
  progress.check();
  progress.end();
  const double rows = tasks > 0 ? double(scene.tasks[tasks - 1].back().end) : 0.0;
  sumUp(tasks > 0 ? rows / double(tasks) : 0, sample);
}

}  // namespace radiosity
