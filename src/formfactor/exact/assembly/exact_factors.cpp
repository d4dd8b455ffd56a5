#include "formfactor/exact/assembly/exact_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/figure_text.h"
#include "base/made.h"
#include "base/processor_clock.h"
#include "formfactor/border_share.h"
#include "formfactor/closed_rows.h"
#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/exact/assembly/task_blocks.h"
#include "formfactor/row_accounts.h"
#include "matrix/dealt_rows.h"
#include "matrix/shared_rows.h"
#include "mesh/patches/canonical_order.h"
#include "mesh/patches/enclosures.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/spelling.h"
#include "visibility/clipping/clip_kernels.h"

namespace radiosity {
namespace {

/// If emitters have more pairs than this, they are not a small part of the scene, and their pairs
/// are evaluated as all others.
constexpr std::size_t kMostEmitterPairs = 1'000'000;
/// A closed row may miss this share of its view and the tolerance: more is no rounding. Corners may
/// be up to the coincidence off their planes, so what passes a strip of that width along the border
/// may be missing, too: little but for patches that are themselves some coincidences wide.
constexpr double kMostMissing = 0.01;

/// The emitters whose light is to be good to some percent at each receiver.
std::vector<Index> emittersOf(const FormFactorOptions& options, std::size_t patches) {
  if (options.exact_rows.size() * patches > kMostEmitterPairs) return {};
  return options.exact_rows;
}

/// The results that rows are stored into, and the inputs that they are made from.
struct RowStore {
  /// `emitting`: patches.
  RowStore(const PatchMesh& mesh, const ExactScene& scene, const FormFactorOptions& options,
           std::span<const Index> emitting, const std::shared_ptr<ScratchMemory>& scratch)
      : matrix(std::make_shared<SymmetricMatrix>(mesh.area, scene.order.patch,
                                                 options.storedPrecision(), scratch)),
        backs(mesh.size(), 0.0),
        seen_backs(mesh.size()),
        enforces(options.closure == ClosureMode::enforce),
        uncertain(enforces ? mesh.size() : 0, scratch) {
    if (!emitting.empty()) emitters.emplace(mesh, scene.order, emitting);
  }
  RowContext context(const ExactScene& scene, const ExactKernels& kernels,
                     std::size_t recheck_every, const Progress& progress) {
    return {scene.elements,
            scene.order,
            scene.chunks,
            scene.visibility,
            kernels.unoccluded,
            kernels.occluded,
            progress,
            recheck_every,
            emitters ? &*emitters : nullptr,
            *matrix,
            enforces ? &uncertain : nullptr,
            backs,
            seen_backs};
  }

  std::shared_ptr<SymmetricMatrix> matrix;
  std::vector<double> backs;
  std::vector<std::vector<SeenBack>> seen_backs;
  bool enforces;
  UncertainEntries uncertain;
  std::optional<Emitters> emitters;
};

RowSums fillRows(RowStore& rows, const ExactScene& scene, const ExactKernels& kernels,
                 std::size_t recheck_every, const RowRun& run) {
  const RowContext context = rows.context(scene, kernels, recheck_every, run.progress);
  TaskBlocks blocks(context, scene.tasks, scene.tasks.size());
  makeAllRows(blocks, run);
  return blocks.sums();
}

void reportCounts(const ExactScene& scene, const RowSums& sums, ExactReport& report) {
  const ElementSet& elements = scene.elements;
  report.elements = elements.patch_elements;
  report.black_elements = elements.size() - elements.patch_elements;
  report.facets = elements.facets.size();
  report.occluders = scene.occluders.occluders.size();
  report.solids = scene.occluders.solids;
  report.skipped_hull = scene.occluders.skipped_hull;
  report.no_exchange = sums.visibility.no_exchange;
  report.unoccluded = sums.visibility.unoccluded;
  report.hidden = sums.visibility.hidden + sums.occluded.hidden;
  report.occluded = sums.visibility.occluded - sums.occluded.hidden;
  report.facet_pairs = sums.visibility.facet_pairs;
  report.facet_pairs_no_exchange = sums.visibility.facet_pairs_no_exchange;
  report.facet_pairs_unoccluded = sums.visibility.facet_pairs_unoccluded;
  report.shaft_tests = sums.visibility.shaft_tests;
  report.contour = sums.unoccluded.contour;
  report.lambert = sums.unoccluded.lambert;
  report.product = sums.unoccluded.product;
  report.clipped = sums.unoccluded.clipped;
  report.points = sums.occluded.points;
  report.subdivided = sums.occluded.subdivided;
  report.evaluated_again = sums.occluded.again;
  report.rechecked = sums.error.rechecked();
  report.recheck_ratio = sums.error.recheckRatio();
  report.seconds_visibility = sums.seconds_visibility;
  report.seconds_unoccluded = sums.seconds_unoccluded;
  report.seconds_occluded = sums.seconds_occluded;
  report.seconds_assembly = sums.seconds_assembly;
}

/// Notes the pairs for which a stage failed, so that a simpler one took its place.
void noteFallbacks(const OccludedCounts& counts, FormFactorReport& report) {
  const auto add = [&](std::size_t pairs, const char* what) {
    if (pairs == 0) return;
    report.notes.push_back(
        {Severity::info, fmt::format("{} occluded {} {}; their errors are "
                                     "part of the error figures",
                                     pairs, pairs == 1 ? "pair" : "pairs", what)});
  };
  add(counts.cut_short, "kept a larger error than asked for: shadows on them are too intricate");
  add(counts.by_segments, "could not be clipped and were sampled by segments");
}

void setErrors(const PatchOrder& order, const ErrorSums& sums, double closed_form,
               FormFactors& result) {
  std::vector<double> figure(order.ranked);
  result.report.error_figure = sums.figures(order.area, closed_form, figure);
  result.error.assign(order.patch.size(), 0.0);
  for (std::size_t k = 0; k < order.ranked; ++k) result.error[order.patch[k]] = figure[k];
}

/// Sets fronts to the sums of the matrix's rows, and the sky of open rows to the rest. What a
/// closed row misses, or any row has beyond 1, is its error.
void setAccounts(const PatchMesh& mesh, const PatchOrder& order, double tolerance,
                 ClosedRows& closed, FormFactors& result) {
  const double coincidence = coincidenceOf(mesh);
  result.fronts = result.matrix->rowSums();
  for (std::size_t k = 0; k < order.ranked; ++k) {
    const Index i = order.patch[k];
    const double rest = 1 - result.fronts[i] - result.backs[i];
    closed.keeps(i, rest, kMostMissing + tolerance + borderShare(mesh, i, coincidence));
    result.sky[i] = std::max(0.0, rest);
  }
  closed.balance(result);
  closed.report(mesh, result.report);
}

/// Rows that sum to more than 1, or less if they are closed, by more than their figures and those
/// of closed forms explain: where faces nearly meet or cross, one can be taken not to hide the
/// other. The figure of such a row becomes the amount, as if one pair had it all.
void findUnexplained(const PatchMesh& mesh, const PatchOrder& order, double closed_form,
                     FormFactors& result) {
  const double terms = std::sqrt(double(order.ranked) + 1);
  std::size_t rows = 0;
  double largest = 0;
  double squares = 0;
  for (std::size_t k = 0; k < order.ranked; ++k) {
    const Index i = order.patch[k];
    double& figure = result.error[i];
    const double off = std::abs(1 - result.fronts[i] - result.backs[i] - result.sky[i]);
    if (off <= terms * figure + closed_form) continue;
    ++rows;
    largest = std::max(largest, off);
    squares += mesh.area[i] * (off * off - figure * figure);
    figure = off;
  }
  if (rows == 0) return;
  FormFactorReport& report = result.report;
  report.error_figure = std::hypot(report.error_figure,
                                   std::sqrt(squares / weightedSquares(pairsOf(*result.matrix))));
  report.notes.push_back(
      {Severity::warning,
       fmt::format("{} {} off a sum of 1 by up to {:.2g}, more than errors of integration explain: "
                   "faces nearly meet or cross there, by little more than the coincidence of "
                   "{:.3g} m; a larger {} joins them; the amount is part of the error figures",
                   countText(rows), rows == 1 ? "row is" : "rows are", largest, coincidenceOf(mesh),
                   spelled("weld"))});
}

/// Reports how far closed rows are from 1 and, if asked to, puts the difference on the occluded
/// pairs.
void close(const PatchOrder& order, const ClosedRows& closed, RowStore& rows, ClosureMode mode,
           FormFactors& result, Progress& progress) {
  std::vector<double> target = result.fronts;
  for (std::size_t k = 0; k < order.ranked; ++k) {
    const Index i = order.patch[k];
    if (closed.closed(i)) target[i] = std::max(0.0, 1 - result.backs[i]);
  }
  FormFactorReport& report = result.report;
  report.closure_enforced = mode == ClosureMode::enforce;
  if (report.closure_enforced) {
    report.closure = closeRows(*rows.matrix, rows.uncertain, target, progress);
    result.fronts = rows.matrix->rowSums();
    closed.balance(result);
  } else {
    report.closure = reportClosure(result.fronts, target);
  }
}

/// A plan clips pairs for this long, in seconds of processors.
constexpr double kClipSeconds = 0.25;

class Exact final : public PreparedMethod {
 public:
  Exact(const PatchMesh& mesh, const FormFactorOptions& options)
      : PreparedMethod(FormFactorMethod::exact, mesh, options) {}

 private:
  Cost foresee(Progress& progress) override;
  FormFactors make(KnownRows known, const RowRun& run) const override;
  std::shared_ptr<const ExchangeMatrix> share(const RowRun& run) const override;

  std::optional<ExactScene> scene_;
  std::optional<RowSample> sample_;  ///< of the scene, while it is planned
  std::optional<ExactKernels> kernels_;
  ExactEstimate estimate_;
};

Exact::Cost Exact::foresee(Progress& progress) {
  if (!scene_) {
    const Stopwatch watch;
    progress.begin("preparing", ExactScene::kSteps);
    scene_.emplace(mesh(), progress);
    progress.end();
    seconds_preparing_ += watch.seconds();
  }
  RowSample& sample = sample_ ? *sample_ : sample_.emplace();
  sampleRows(*scene_, tolerance(), sample, progress);
  estimate_ = estimateExact(*scene_, sample, options());
  if (!kernels_) {
    const Stopwatch watch;
    kernels_.emplace(*scene_, options());
    seconds_preparing_ += watch.seconds();
  }
  Cost cost{{}, estimate_.memory};
  cost.plan.matrix_bytes = estimate_.matrix_bytes;
  cost.plan.seconds = exactSeconds(*scene_, *kernels_, sample, options(), kClipSeconds, progress);
  cost.plan.tolerance = tolerance();
  cost.plan.refining = estimate_.work > 0 ? estimate_.refining / estimate_.work : 0.0;
  sample_.reset();
  return cost;
}

FormFactors Exact::make(KnownRows /*known*/, const RowRun& run) const {
  const ExactScene& scene = made(scene_);
  const ExactKernels& kernels = made(kernels_);
  const std::size_t n = mesh().size();
  FormFactors result;
  FormFactorReport& report = result.report;
  report.simd_target = clipKernels(options().simd).target;
  report.empty_rows = n - scene.order.ranked;

  std::vector<Index> emitting = emittersOf(options(), mesh().size());
  std::size_t recheck_every = recheckEvery(estimate_.occluded_pairs, tolerance());
  if (run.processes != nullptr) {
    run.processes->broadcastValue(recheck_every);
    run.processes->broadcastArray(emitting);
  }
  RowStore rows(mesh(), scene, options(), emitting, run.scratch);
  const RowSums sums = fillRows(rows, scene, kernels, recheck_every, run);
  Progress& progress = run.progress;  // the matrix outlives `run`
  const auto check = [&progress] { progress.check(); };
  if (run.processes != nullptr) evenOut(*run.processes, *rows.matrix, check);
  result.matrix = wholeMatrix(run.processes, rows.matrix, check);
  result.backs = std::move(rows.backs);
  result.sky.assign(n, 0.0);
  const Stopwatch finishing;
  reportCounts(scene, sums, report.exact);
  noteFallbacks(sums.occluded, report);
  setErrors(scene.order, sums.error, kernels.closed_form, result);
  ClosedRows closed(mesh());
  setAccounts(mesh(), scene.order, tolerance(), closed, result);
  findUnexplained(mesh(), scene.order, kernels.closed_form, result);
  if (closed.any() && options().closure != ClosureMode::off) {
    close(scene.order, closed, rows, options().closure, result, progress);
  }
  progress.begin("finishing", 1);
  accountForBacks(mesh(), canonicalOrder(mesh()), mesh().area, rows.seen_backs, result);
  progress.advance();
  progress.end();
  progress.check();
  report.exact.seconds_prepare = seconds_preparing_;
  report.exact.seconds_finish = finishing.seconds();
  return result;
}

std::shared_ptr<const ExchangeMatrix> Exact::share(const RowRun& run) const {
  const ExactScene scene(mesh(), run.progress);
  const ExactKernels kernels(scene, options());
  std::size_t recheck_every = 1;
  run.processes->broadcastValue(recheck_every);
  std::vector<Index> emitting;
  run.processes->broadcastArray(emitting);
  RowStore rows(mesh(), scene, options(), emitting, nullptr);
  fillRows(rows, scene, kernels, recheck_every, run);
  evenOut(*run.processes, *rows.matrix, {});
  return rows.matrix;
}

}  // namespace

std::unique_ptr<PreparedMethod> prepareExact(const PatchMesh& mesh,
                                             const FormFactorOptions& options) {
  return std::make_unique<Exact>(mesh, options);
}

}  // namespace radiosity
