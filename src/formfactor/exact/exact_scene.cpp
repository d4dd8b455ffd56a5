#include "formfactor/exact/exact_scene.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <vector>

#include "formfactor/exact/partial_cost.h"
#include "formfactor/exact/recorded_pairs.h"
#include "matrix/work_bytes.h"

namespace radiosity {
namespace {

constexpr std::size_t kSamples = 12;       // tasks
constexpr std::size_t kSampledPairs = 96;  // of a task

struct Sample {
  double pairs = 0;       ///< of all, in the sampled rows
  double unoccluded = 0;  ///< of them, or below the horizon
  double partial = 0;
  double occluders = 0;  ///< candidates, summed over partial pairs
  PartialCost cost;      ///< of the partial pairs
  VisibilityCounts counts;
  std::size_t task_bytes = 0;  ///< most that the clipped pairs of a task take
};

/// From some of them, evenly.
PartialCost costOfPairs(const ExactScene& scene, const RecordedPairs& recorded, double tolerance) {
  const std::size_t pairs = recorded.partial_pairs.size();
  const std::size_t samples = std::min(pairs, kSampledPairs);
  std::vector<PartialPair> some;
  for (std::size_t k = 0; k < samples; ++k) {
    some.push_back(recorded.partial_pairs[(2 * k + 1) * pairs / (2 * samples)]);
  }
  if (samples == 0) return {};
  return partialCost(scene.elements, scene.occluders, some, recorded.occluder_list, tolerance) *
         (double(pairs) / double(samples));
}

Sample sampleTasks(const ExactScene& scene, double tolerance) {
  Sample sample;
  RecordedPairs recorded;
  const std::size_t tasks = scene.tasks.size();
  const std::size_t samples = std::min(tasks, kSamples);
  for (std::size_t k = 0; k < samples; ++k) {
    recorded.clear();
    for (const ElementRange& range : scene.tasks[(2 * k + 1) * tasks / (2 * samples)]) {
      scene.visibility.classify(range, recorded, sample.counts);
      sample.pairs += double(range.size()) * double(scene.elements.size() - range.end);
    }
    for (const PairBlock& block : recorded.blocks) {
      sample.unoccluded += double(block.rows.size()) * double(block.columns.size());
    }
    sample.partial += double(recorded.partial_pairs.size());
    sample.occluders += double(recorded.occluder_list.size());
    sample.cost += costOfPairs(scene, recorded, tolerance);
    sample.task_bytes = std::max(
        sample.task_bytes, recorded.partial_pairs.size() *
                                   (sizeof(PartialPair) + sizeof(PartialExchange) + sizeof(Index)) +
                               recorded.occluder_list.size() * sizeof(Index) +
                               recorded.blocks.size() * sizeof(PairBlock));
  }
  return sample;
}

}  // namespace

ExactScene::ExactScene(const PatchMesh& mesh)
    : elements(mesh),
      occluders(mesh, elements),
      visibility(elements, occluders),
      order(mesh, elements),
      tasks(elements),
      chunks(elements) {}

ExactEstimate estimateExact(const ExactScene& scene, const FormFactorOptions& options) {
  const Sample sample = sampleTasks(scene, options.tolerance);
  const auto elements = double(scene.elements.size());
  const auto patches = double(scene.elements.patch_elements);
  const double all_pairs = 0.5 * elements * elements;
  const double share = sample.pairs > 0 ? all_pairs / sample.pairs : 0;
  ExactEstimate estimate;
  estimate.partial_pairs = share * sample.partial;
  estimate.occluders_per_partial = sample.partial > 0 ? sample.occluders / sample.partial : 0;
  const double entries = share * (sample.unoccluded + sample.partial);
  estimate.entries_per_row = patches > 0 ? std::min(2 * entries / patches, patches) : 0;

  const std::size_t n = scene.order.patch.size();
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  constexpr std::size_t kElementBytes = 512;  // an element, its cluster, the kernels' copies
  constexpr std::size_t kAccounts = 8 * sizeof(double);
  const std::size_t row_sums = 4 * 2 * sizeof(double) * scene.order.ranked;
  const std::size_t filling =
      threads * (scene.tasks.panelBytes(scene.elements) + row_sums + 2 * sample.task_bytes);
  estimate.bytes = ExchangeMatrix::estimateSymmetricBytes(n, estimate.entries_per_row,
                                                          options.storedPrecision()) +
                   n * kAccounts + scene.elements.size() * kElementBytes +
                   std::max(filling, matrixWorkBytes(n, threads));  // one after the other

  // Measured on one core of a 2.7 GHz Xeon: a pair in closed form or by quadrature, with what is
  // asked for beside it, and a test whether something stands between.
  constexpr double kUnoccluded = 5e-8;
  constexpr double kShaftTest = 9e-8;
  const double visibility = kShaftTest * double(sample.counts.shaft_tests);
  estimate.seconds = share * (kUnoccluded * sample.unoccluded + visibility + sample.cost.seconds);
  estimate.refining = share * sample.cost.refining;
  estimate.points = share * sample.cost.points;
  return estimate;
}

}  // namespace radiosity
