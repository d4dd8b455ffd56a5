#include "formfactor/exact/assembly/exact_scene.h"

#include <algorithm>

#include "base/parallel.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/exact/assembly/row_times.h"
#include "formfactor/foreseen_work.h"
#include "matrix/expected_bytes.h"
#include "matrix/working_memory.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

/// Closed forms hold this relative error at the default tolerance, and the tolerance itself where
/// it is tighter than this.
constexpr double kClosedForm = 1e-5;
/// At looser tolerances than the default, closed forms hold this share of the tolerance: their true
/// error, mostly a tenth of that, then disappears beside the error of the clipped pairs.
constexpr double kClosedFormShare = 0.1;
/// The loosest accuracy for which the kernels are published.
constexpr double kLoosest = 1e-2;

double closedFormTolerance(double tolerance) {
  if (tolerance <= FormFactorOptions::kExactTolerance) return std::min(tolerance, kClosedForm);
  return std::min(kClosedFormShare * tolerance, kLoosest);
}

/// Makes one of the scene's parts, then a step of progress, at which the run may end.
template <class Make>
auto part(Progress& progress, const Make& make) {
  auto made = make();
  progress.advance();
  progress.check();
  return made;
}

}  // namespace

ExactScene::ExactScene(const PatchMesh& mesh, Progress& progress,
                       std::span<const std::uint8_t> leading)
    : elements(part(progress, [&] { return ElementSet(mesh, progress, leading); })),
      occluders(part(progress, [&] { return OccluderSet(mesh, elements, progress); })),
      visibility(elements, occluders),
      order(mesh, elements),
      tasks(elements),
      chunks(elements) {
  progress.advance();
}

std::size_t ExactScene::leadingTasks() const {
  std::size_t count = 0;
  while (count < tasks.size() && tasks[count].front().first < elements.leading_elements) ++count;
  return count;
}

ExactKernels::ExactKernels(const ExactScene& scene, const FormFactorOptions& options)
    : closed_form(closedFormTolerance(options.toleranceOf(FormFactorMethod::exact))),
      unoccluded(scene.elements, closed_form, options.simd),
      occluded(scene.elements, scene.occluders, options.toleranceOf(FormFactorMethod::exact),
               options.simd) {}

ExactEstimate estimateExact(const ExactScene& scene, const RowSample& sample,
                            const FormFactorOptions& options) {
  const auto patches = double(scene.elements.patch_elements);
  ExactEstimate estimate;
  estimate.occluded_pairs = sample.occluded;
  estimate.occluders_per_pair = sample.occluded > 0 ? sample.occluders / sample.occluded : 0;
  const double entries = sample.unoccluded + sample.occluded;
  estimate.entries_per_row = patches > 0 ? std::min(2 * entries / patches, patches) : 0;

  const std::size_t n = scene.order.patch.size();
  constexpr std::size_t kElementBytes = 512;  // an element, its cluster, the kernels' copies
  constexpr std::size_t kAccounts = 8 * sizeof(double);
  constexpr std::size_t kUncertainBytes =
      4;  // of an occluded pair, for closure: code, run, freedom
  const bool enforces = options.closure == ClosureMode::enforce;
  const std::size_t row_sums = 4 * 2 * sizeof(double) * scene.order.ranked;
  const std::size_t filling = allowedThreads() * (scene.tasks.panelBytes(scene.elements) +
                                                  row_sums + 2 * sample.task_bytes);
  estimate.matrix_bytes =
      expectedSymmetricBytes(n, estimate.entries_per_row, options.storedPrecision());
  const std::size_t rows =
      estimate.matrix_bytes + (enforces ? std::size_t(sample.occluded) * kUncertainBytes : 0);
  const std::size_t always =
      options.memory_held + n * kAccounts + scene.elements.size() * kElementBytes;
  // Filling and writing come one after the other.
  const std::size_t working = matrixWorkingMemory(n, allowedThreads());
  const std::size_t panels = panelsOf(estimate.matrix_bytes, options.storedPrecision());
  estimate.memory = planRowMemory(always + rows + std::max(filling, working + panels),
                                  always + std::max(filling, working), rows, options);

  estimate.work =
      kUnoccludedWork * sample.unoccluded + kShaftTestWork * sample.shaft_tests + sample.cost.work;
  estimate.refining = sample.cost.refining;
  estimate.points = sample.cost.points;
  return estimate;
}

double exactSeconds(const ExactScene& scene, const ExactKernels& kernels, const RowSample& sample,
                    const FormFactorOptions& options, double clip_seconds, Progress& progress) {
  progress.begin("trying rows", 1);
  const double tolerance = options.toleranceOf(FormFactorMethod::exact);
  const RowTimes times = timeRows(scene, kernels, tolerance, clip_seconds, sample, progress);
  progress.advance();
  progress.end();
  return times.busy * (times.visibility + times.unoccluded + times.occluded) /
         double(allowedThreads());
}

}  // namespace radiosity
