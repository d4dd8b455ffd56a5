#include "formfactor/rays/ray_factors.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/figure_text.h"
#include "base/made.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/scratch_rows.h"
#include "formfactor/closed_rows.h"
#include "formfactor/rays/cast_blocks.h"
#include "formfactor/rays/ray_model.h"
#include "formfactor/rays/ray_rounds.h"
#include "formfactor/row_accounts.h"
#include "matrix/dealt_rows.h"
#include "matrix/shared_rows.h"
#include "radiosity/closure.h"

namespace radiosity {
namespace {

/// The tolerance to which single precision can restore rows.
constexpr double kClosureTolerance = 1e-9;

/// What rows see beside the matrix, and the errors of its shares: K values each.
struct Beside {
  explicit Beside(std::size_t n) : sky_error(n, 0.0), backs_error(n, 0.0), seen_backs(n) {}

  std::vector<double> sky_error;
  std::vector<double> backs_error;
  std::vector<std::vector<SeenBack>> seen_backs;
};

/// The error of a share of a row: the spread of its rays, and at least one ray.
double shareError(double of_row, double each) {
  const double share = std::clamp(of_row, 0.0, 1.0);
  return std::sqrt(share * (1 - share) * each + each * each);
}

/// The error of a form factor merged from both ends, with rays a square metre and area of its own
/// and of the other one: that of independent rays, which is above the true one, but good as a
/// weight. At least one ray, as shareError().
double mergedError(double factor, const std::array<double, 2>& density,
                   const std::array<double, 2>& area) {
  const double each = 1 / ((density[0] + density[1]) * area[0]);
  const double hits = factor / each;
  const double own = hits * density[0] / (density[0] + density[1]);
  const double variance = pairHitsVariance(factor, {own, hits - own}, area);
  return std::min(1.0, each * std::sqrt(std::max(1.0, variance)));
}

/// Fronts, backs and sky of each row, by its own rays alone. Known entries replace the rays that
/// ended there; all other rays share the rest of the row.
void setAccounts(const RayScene& scene, const KnownEntries& known, const ClosedRows& closed,
                 const std::vector<RayRow>& rows, ScratchMemory* scratch, FormFactors& result,
                 Beside& beside) {
  const std::size_t n = rows.size();
  parallelFor(n, 64, [&](std::size_t k) {
    const RayRow& row = rows[k];
    touchRows(scratch, row.bytes());
    const Index i = scene.order()[k];
    if (!(row.counted() > 0)) return;
    if (known.rowAt(k) != nullptr) {
      const RowAccount account = known.account(k, scene.area()[k], closed.closed(i));
      result.fronts[i] = account.fronts;
      result.backs[i] = account.backs;
      result.sky[i] = account.sky;
      beside.seen_backs[i] = known.rowAt(k)->backs;
      for (const KnownEntries::Entry& entry : known.at(k)) {
        if (!closed.closed(i)) beside.sky_error[i] += entry.error / scene.area()[k];
      }
      return;
    }
    const double known_share = known.share(k, scene.area()[k]);
    const double sky = row.countedSky();
    double counted = row.counted() - (closed.closed(i) ? sky : 0.0);  // leaks count for nothing
    for (std::size_t e = 0; e < row.columns.size() && row.columns[e] < n; ++e) {
      if (known.rowAt(row.columns[e]) == nullptr) continue;
      counted -= double(row.hits[e][0]) + double(row.hits[e][1]);
    }
    const double each = counted > 0 ? std::max(0.0, 1 - known_share) / counted : 0.0;
    double fronts = known_share;
    for (std::size_t e = 0; e < row.columns.size(); ++e) {
      const double share = (double(row.hits[e][0]) + double(row.hits[e][1])) * each;
      if (row.columns[e] >= n) {
        result.backs[i] += share;
        beside.seen_backs[i].push_back({Index(row.columns[e] - n), share});
      } else if (known.rowAt(row.columns[e]) == nullptr) {
        fronts += share;
      }
    }
    result.fronts[i] = fronts;
    if (!closed.closed(i)) {
      result.sky[i] = sky * each;
      beside.sky_error[i] = shareError(result.sky[i], each);  // that saw none may have missed it
    }
    // Most scenes have no backs to be missed.
    if (result.backs[i] > 0) beside.backs_error[i] = shareError(result.backs[i], each);
  });
}

/// Notes rows that have stayed unknown. `usual`: the norm of a usual row.
void noteUnknown(const std::vector<RowAccuracy>& rows, double usual, double tolerance,
                 FormFactorReport& report) {
  // Rounds have judged rows by norms that have changed since, by some per cent.
  constexpr double kSlack = 1.5;
  std::size_t unknown = 0;
  double most = 0;
  for (const RowAccuracy& row : rows) {
    if (!row.isUnknown()) continue;
    const double error = row.expectedError();
    if (error <= kSlack * tolerance * std::max(row.norm, usual)) continue;
    ++unknown;
    most = std::max(most, error);
  }
  if (unknown == 0) return;
  report.notes.push_back(
      {Severity::warning,
       fmt::format(
           "{} of {} rows have seen next to nothing when rays stopped at {:.2g} million: what they "
           "see of others, up to {:.2g} of their view, is unknown; {} finds it",
           countText(unknown), countText(rows.size()), 1e-6 * double(report.rays.rays), most,
           spelled("method", "exact"))});
}

/// Stores the matrix, its error figures and the error of each entry.
void store(const RayScene& scene, const KnownEntries& known, const std::vector<RayRow>& rows,
           const RayAim& aim, ScratchMemory* scratch, SymmetricMatrix& matrix, FormFactors& result,
           UncertainEntries& uncertain) {
  const std::size_t n = rows.size();
  std::vector<double> density(n);
  for (std::size_t k = 0; k < n; ++k) {
    density[k] = scene.area()[k] > 0 ? rows[k].counted() / scene.area()[k] : 0.0;
  }
  std::vector<RowAccuracy> accuracy(n);
  struct Upper {
    std::vector<Index> positions;
    std::vector<double> factors;
    std::vector<double> errors;
  };
  tbb::enumerable_thread_specific<Upper> uppers;
  forMergedRows(rows, scene.area(), known, {}, scratch, [&](const MergedRow& merged) {
    const std::size_t k = merged.position;
    Upper& upper = uppers.local();
    upper.positions.clear();
    upper.factors.clear();
    upper.errors.clear();
    accuracy[k] = accuracyOf(merged, rows[k], scene.area()[k]);
    if (!merged.all_known) accuracy[k].unresolved = scene.unresolved()[k];
    const auto& columns = merged.columns;
    const auto from = std::lower_bound(columns.begin(), columns.end(), k);
    auto next_known = merged.known.begin();
    for (std::size_t e = std::size_t(from - columns.begin()); e < columns.size(); ++e) {
      const Index j = columns[e];
      const double value = 0.5 * (merged.factors[e][0] + merged.factors[e][1]);
      upper.positions.push_back(j);
      upper.factors.push_back(value);
      while (next_known != merged.known.end() && next_known->position < j) ++next_known;
      if (next_known != merged.known.end() && next_known->position == j) {
        upper.errors.push_back(std::min(1.0, next_known->error / scene.area()[k]));
        continue;
      }
      upper.errors.push_back(mergedError(value, {density[k], j == k ? 0.0 : density[j]},
                                         {scene.area()[k], scene.area()[j]}));
    }
    matrix.setUpperRow(k, upper.positions, upper.factors);
    uncertain.setRow(k, upper.positions, upper.errors);
  });
  double squares = 0;
  double norms = 0;
  UsualNorm usual;
  CommonError common;
  for (const RowAccuracy& row : accuracy) common.add(row);
  for (std::size_t k = 0; k < n; ++k) {
    const RowAccuracy row = common.moderated(accuracy[k]);
    const double figure = row.figure();
    result.error[scene.order()[k]] = figure;
    const double error = row.expectedError();
    squares += scene.area()[k] * (error * error + row.known_error * row.known_error +
                                  row.unresolved * row.unresolved);
    const double norm = std::hypot(row.norm, aim.sky_weight * result.sky[scene.order()[k]]);
    accuracy[k].norm = norm;
    usual.add(norm, scene.area()[k]);
    norms += scene.area()[k] * norm * norm;
    if (norm > 0) {
      double& largest = result.report.rays.largest_row_figure;
      largest = std::max(largest, figure / norm);
    }
  }
  // What has not been seen, or next to nothing of it, is off by as much as all of it.
  const double most = std::max(squares, norms);
  result.report.error_figure = most > 0 ? std::sqrt(squares / most) : 0.0;
  noteUnknown(accuracy, usual.value(),
              result.report.rays.loosened_tolerance.value_or(aim.tolerance), result.report);
}

/// Adds to a row's backs their part of what all beside the matrix has `gained`, by the squares of
/// the errors of backs and sky.
void moveBacks(std::size_t i, double gained, Beside& beside, FormFactors& result) {
  double& backs = result.backs[i];
  if (!(beside.backs_error[i] > 0)) return;
  const double ratio = beside.sky_error[i] / beside.backs_error[i];
  const double all = backs + result.sky[i] + gained;
  const double moved = std::clamp(backs + gained / (1 + ratio * ratio), 0.0, std::max(all, 0.0));
  for (SeenBack& seen : beside.seen_backs[i]) seen.share *= moved / backs;
  backs = moved;
}

/// By its own rays, fronts, backs and sky of a row sum to 1; merging has moved the fronts. The
/// difference goes to fronts, backs and, in open rows, the sky, each by its error.
void close(const ClosedRows& closed, const UncertainEntries& uncertain, ClosureMode mode,
           SymmetricMatrix& matrix, Beside& beside, FormFactors& result, Progress& progress) {
  if (mode == ClosureMode::off) {
    result.fronts = matrix.rowSums();
    return;
  }
  FormFactorReport& report = result.report;
  const std::size_t n = result.fronts.size();
  std::vector<double> share = result.backs;
  std::vector<double> error = beside.backs_error;
  for (std::size_t i = 0; i < n; ++i) {
    share[i] += result.sky[i];
    error[i] = std::hypot(error[i], beside.sky_error[i]);
  }
  report.closure =
      closeRows(matrix, uncertain, result.fronts, progress, kClosureTolerance, {share, error});
  report.closure_enforced = true;
  const std::vector<double> sums = matrix.rowSums();
  for (std::size_t i = 0; i < n; ++i) {
    // Keep a sum aimed at, if nothing else has moved: storing rounds those of the matrix.
    if (closed.closed(i) && report.closure.reached && !(beside.backs_error[i] > 0)) continue;
    moveBacks(i, result.fronts[i] - sums[i], beside, result);
    result.fronts[i] = sums[i];
  }
}

/// Rows that are known cannot give way to the counts of others, where faces nearly meet and views
/// from both ends differ: what they sum to beyond 1 is their error, if it is more than their figure
/// explains.
void stateExcess(FormFactors& result) {
  const double terms = std::sqrt(double(result.fronts.size()) + 1);
  for (std::size_t i = 0; i < result.fronts.size(); ++i) {
    const double excess = result.fronts[i] + result.backs[i] + result.sky[i] - 1;
    if (excess > terms * result.error[i]) result.error[i] = excess;
  }
}

void noteLoosened(const FormFactorOptions& options, FormFactorReport& report) {
  if (!report.rays.loosened_tolerance) return;
  const double tolerance = options.toleranceOf(FormFactorMethod::rays);
  report.notes.push_back(
      {Severity::info,
       fmt::format("rays stopped at {} million, where rows are to {:.2g}; {} asks for "
                   "as many as that takes",
                   std::llround(1e-6 * double(report.rays.rays)), *report.rays.loosened_tolerance,
                   spelled("tolerance", fmt::format("{}", tolerance)))});
}

/// Deals the rows out to all processes.
std::shared_ptr<const ExchangeMatrix> shared(Processes& processes, Progress& progress,
                                             const SymmetricMatrix& matrix) {
  const WhileWaiting waiting = [&progress] { progress.check(); };
  return std::make_shared<SharedRows>(processes, dealRows(processes, matrix, waiting), waiting);
}

/// The rows that are closed, and the count of rays that leave them.
ClosedRows closedRows(const PatchMesh& mesh, const RayScene& scene, const std::vector<RayRow>& rows,
                      FormFactorReport& report) {
  ClosedRows closed(mesh);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (!closed.keeps(scene.order()[k], rows[k].skyShare(), ClosedRows::kMostLeaks)) continue;
    report.rays.leaked += rows[k].sky[0] + rows[k].sky[1];
  }
  closed.report(mesh, report);
  return closed;
}

class Rays final : public PreparedMethod {
 public:
  Rays(const PatchMesh& mesh, const FormFactorOptions& options)
      : PreparedMethod(FormFactorMethod::rays, mesh, options) {}
  std::optional<RoomForExactRows> roomForExactRows() const override {
    return RoomForExactRows{kExactWorkARay * estimate_.rays, estimate_.memory.bytes};
  }

 private:
  Cost foresee(Progress& progress) override;
  FormFactors make(KnownRows exact, const RowRun& run) const override;
  std::shared_ptr<const ExchangeMatrix> share(const RowRun& run) const override;

  std::optional<RayScene> scene_;
  RayEstimate estimate_;
};

Rays::Cost Rays::foresee(Progress& progress) {
  progress.begin("preparing", 1);
  const Stopwatch watch;
  scene_.emplace(mesh(), options().seed);
  seconds_preparing_ = watch.seconds();
  progress.advance();
  progress.end();
  progress.check();
  estimate_ = estimateRays(*scene_, options(), progress);
  Cost cost{{}, estimate_.memory};
  FormFactorPlan& plan = cost.plan;
  plan.matrix_bytes = estimate_.matrix_bytes;
  plan.seconds = estimate_.seconds;
  plan.tolerance = estimate_.tolerance;
  // Error squared falls as n^-p with the number n of rays, p = kUsualOrder.
  plan.refining = 1;
  plan.refining_order = 2 / kUsualOrder;
  if (plan.tolerance > tolerance()) plan.seconds_to_tolerance = estimate_.seconds_to_tolerance;
  return cost;
}

FormFactors Rays::make(KnownRows exact, const RowRun& run) const {
  const RayScene& scene = made(scene_);
  const std::size_t n = scene.size();
  FormFactors result;
  FormFactorReport& report = result.report;
  Progress& progress = run.progress;
  const std::shared_ptr<ScratchMemory>& scratch = run.scratch;
  std::vector<double> area(n);
  for (std::size_t k = 0; k < n; ++k) area[scene.order()[k]] = scene.area()[k];
  report.empty_rows = std::size_t(std::count(area.begin(), area.end(), 0.0));
  report.rays.triangles = scene.caster().triangles();
  report.rays.seconds_prepare = seconds_preparing_ + exact.seconds;
  const KnownEntries known(std::move(exact.rows), scene.position());

  RayAim aim(options());
  aim.foreseen_rays = estimate_.rays;
  std::vector<RayRow> rows = castRows(scene, known, aim, report.rays, run);
  noteLoosened(options(), report);
  const ClosedRows closed = closedRows(mesh(), scene, rows, report);
  const auto matrix = std::make_shared<SymmetricMatrix>(std::move(area), scene.order(),
                                                        options().storedPrecision(), scratch);
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  result.error.assign(n, 0.0);
  Beside beside(n);
  UncertainEntries uncertain(n, scratch);
  const double storing = clockSeconds();
  setAccounts(scene, known, closed, rows, scratch.get(), result, beside);
  store(scene, known, rows, aim, scratch.get(), *matrix, result, uncertain);
  rows = {};
  progress.check();
  const double closing = clockSeconds();
  report.rays.seconds_merge += closing - storing;
  close(closed, uncertain, options().closure, *matrix, beside, result, progress);
  closed.balance(result);
  stateExcess(result);
  accountForBacks(mesh(), scene.order(), matrix->area(), beside.seen_backs, result);
  report.rays.seconds_close = clockSeconds() - closing;
  result.matrix = matrix;
  if (run.processes != nullptr) result.matrix = shared(*run.processes, progress, *matrix);
  return result;
}

std::shared_ptr<const ExchangeMatrix> Rays::share(const RowRun& run) const {
  const RowRun unkept{run.progress, nullptr, run.processes};  // process 0 keeps all rows
  const RayScene scene(mesh(), options().seed);
  for (;;) {
    CastBlocks round(scene, unkept);
    if (round.count() == 0) break;
    makeBlocks(round, unkept);
  }
  return receiveRows(*run.processes);
}

}  // namespace

std::unique_ptr<PreparedMethod> prepareRays(const PatchMesh& mesh,
                                            const FormFactorOptions& options) {
  return std::make_unique<Rays>(mesh, options);
}

}  // namespace radiosity
