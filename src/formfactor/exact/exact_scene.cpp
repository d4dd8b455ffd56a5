#include "formfactor/exact/exact_scene.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <vector>

#include "formfactor/exact/recorded_pairs.h"
#include "matrix/work_bytes.h"

namespace radiosity {
namespace {

constexpr std::size_t kSamples = 12;  // tasks

struct Sample {
  double pairs = 0;       ///< of all, in the sampled rows
  double unoccluded = 0;  ///< of them, or below the horizon
  double partial = 0;
  double occluders = 0;        ///< candidates, summed over partial pairs
  double edges = 0;            ///< of the candidates
  std::size_t task_bytes = 0;  ///< most that the clipped pairs of a task take
};

Sample sampleTasks(const ExactScene& scene) {
  Sample sample;
  RecordedPairs recorded;
  VisibilityCounts counts;
  const std::size_t tasks = scene.tasks.size();
  const std::size_t samples = std::min(tasks, kSamples);
  for (std::size_t k = 0; k < samples; ++k) {
    recorded.clear();
    for (const ElementRange& range : scene.tasks[(2 * k + 1) * tasks / (2 * samples)]) {
      scene.visibility.classify(range, recorded, counts);
      sample.pairs += double(range.size()) * double(scene.elements.size() - range.end);
    }
    for (const PairBlock& block : recorded.blocks) {
      sample.unoccluded += double(block.rows.size()) * double(block.columns.size());
    }
    sample.partial += double(recorded.partial_pairs.size());
    sample.occluders += double(recorded.occluder_list.size());
    for (const Index o : recorded.occluder_list) {
      sample.edges += double(scene.occluders.occluders[o].edges.size());
    }
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
  const Sample sample = sampleTasks(scene);
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

  // Measured on one core of a 2.7 GHz Xeon: a pair in closed form or by quadrature, and a partly
  // hidden one with what each edge of what may be in between adds. Twice off either way.
  constexpr double kUnoccluded = 6e-9;
  constexpr double kPartial = 5e-7;
  constexpr double kEdge = 1.5e-7;
  estimate.seconds = kUnoccluded * share * sample.unoccluded + kPartial * estimate.partial_pairs +
                     kEdge * share * sample.edges;
  return estimate;
}

}  // namespace radiosity
