#include "formfactor/rays/ray_factors.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/processor_clock.h"
#include "base/scratch_rows.h"
#include "formfactor/rays/ray_rounds.h"
#include "formfactor/rays/shared_rays.h"
#include "formfactor/row_accounts.h"
#include "matrix/dealt_rows.h"
#include "matrix/shared_rows.h"
#include "radiosity/closure.h"

namespace radiosity {
namespace {

/// The tolerance to which single precision can restore rows.
constexpr double kClosureTolerance = 1e-9;

/// The error of the sky's share of a row: the spread of its rays, and at least one ray, since a row
/// that saw no sky may have missed it.
double skyError(double sky, double each) {
  const double share = std::clamp(sky, 0.0, 1.0);
  return std::sqrt(share * (1 - share) * each + each * each);
}

/// Fronts, backs and sky of each row, by its own rays alone. Known entries replace the rays that
/// ended there; all other rays share the rest of the row. `sky_error`: of the sky's share.
void setAccounts(const RayScene& scene, const KnownEntries& known, const std::vector<RayRow>& rows,
                 ScratchMemory* scratch, FormFactors& result, std::vector<double>& sky_error,
                 std::vector<std::vector<SeenBack>>& seen_backs) {
  const std::size_t n = rows.size();
  parallelFor(n, 64, [&](std::size_t k) {
    const RayRow& row = rows[k];
    touchRows(scratch, row.bytes());
    const Index i = scene.order()[k];
    if (!(row.counted() > 0)) return;
    if (known.rowAt(k) != nullptr) {
      const RowAccount account = known.account(k, scene.area()[k], result.report.closed);
      result.fronts[i] = account.fronts;
      result.backs[i] = account.backs;
      result.sky[i] = account.sky;
      seen_backs[i] = known.rowAt(k)->backs;
      for (const KnownEntries::Entry& entry : known.at(k)) {
        sky_error[i] += entry.error / scene.area()[k];
      }
      return;
    }
    const double known_share = known.share(k, scene.area()[k]);
    double counted = row.counted();
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
        seen_backs[i].push_back({Index(row.columns[e] - n), share});
      } else if (known.rowAt(row.columns[e]) == nullptr) {
        fronts += share;
      }
    }
    result.fronts[i] = fronts;
    result.sky[i] = (double(row.sky[0]) + double(row.sky[1])) * each;
    sky_error[i] = skyError(result.sky[i], each);
  });
}

/// Stores the matrix, its error figures and the error of each entry. `sky_weight`: see
/// FormFactorOptions::skyWeight().
void store(const RayScene& scene, const KnownEntries& known, const std::vector<RayRow>& rows,
           double sky_weight, ScratchMemory* scratch, FormFactors& result,
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
      // The variance of independent rays: above the true one, but good as a weight.
      const double variance = value / ((density[k] + density[j]) * scene.area()[k]);
      upper.errors.push_back(std::min(1.0, std::sqrt(variance)));
    }
    result.matrix.setUpperRow(k, upper.positions, upper.factors);
    const std::size_t itself = !upper.positions.empty() && upper.positions[0] == k ? 1 : 0;
    uncertain.setRow(k, std::span(upper.positions).subspan(itself),
                     std::span(upper.errors).subspan(itself));
  });
  double squares = 0;
  double norms = 0;
  CommonError common;
  for (const RowAccuracy& row : accuracy) common.add(row);
  for (std::size_t k = 0; k < n; ++k) {
    const RowAccuracy row = common.moderated(accuracy[k]);
    const double figure = row.figure();
    result.error[scene.order()[k]] = figure;
    squares += scene.area()[k] * (row.error * row.error + row.known_error * row.known_error);
    const double norm = std::hypot(row.norm, sky_weight * result.sky[scene.order()[k]]);
    norms += scene.area()[k] * norm * norm;
    if (norm > 0) {
      double& largest = result.report.rays.largest_row_figure;
      largest = std::max(largest, figure / norm);
    }
  }
  result.report.error_figure = norms > 0 ? std::sqrt(squares / norms) : 0.0;
}

/// By its own rays, fronts, backs and sky of a row sum to 1; merging has moved the fronts. The
/// difference goes to fronts and, in an open scene, to the sky, each by its error.
void close(const UncertainEntries& uncertain, const std::vector<double>& sky_error,
           ClosureMode mode, FormFactors& result, Progress& progress) {
  if (mode != ClosureMode::off) {
    SharesBeside sky;
    if (!result.report.closed) sky = {result.sky, sky_error};
    result.report.closure =
        closeRows(result.matrix, uncertain, result.fronts, progress, kClosureTolerance, sky);
    result.report.closure_enforced = true;
    // Keep the sums aimed at: storing rounds those of the matrix.
    if (result.report.closed && result.report.closure.reached) return;
  }
  result.fronts = result.matrix.rowSums();
}

/// Sets the sky to the rest of each row, and to 0 in a closed scene.
void balance(FormFactors& result) {
  FormFactorReport& report = result.report;
  for (std::size_t i = 0; i < result.fronts.size(); ++i) {
    if (result.fronts[i] + result.backs[i] + result.sky[i] == 0) continue;
    const double rest = 1 - result.fronts[i] - result.backs[i];
    report.largest_row_error =
        std::max(report.largest_row_error, report.closed ? std::abs(rest) : -rest);
    result.sky[i] = report.closed ? 0.0 : rest;
  }
}

void noteLoosened(const FormFactorOptions& options, FormFactorReport& report) {
  if (!report.rays.loosened_tolerance) return;
  const double tolerance = options.toleranceOf(FormFactorMethod::rays);
  report.notes.push_back(
      {Severity::info,
       fmt::format("rays stopped at {} million, where rows are to {:.2g}; --tolerance {} asks for "
                   "as many as that takes",
                   std::llround(1e-6 * double(report.rays.rays)), *report.rays.loosened_tolerance,
                   tolerance)});
}

/// Deals the rows out to all processes.
void share(Processes& processes, Progress& progress, ExchangeMatrix& matrix) {
  const WhileWaiting waiting = [&progress] { progress.check(); };
  ExchangeMatrix own = dealRows(processes, matrix, waiting);
  matrix = ExchangeMatrix::shared(std::make_shared<SharedRows>(processes, std::move(own), waiting));
}

bool seesSky(const std::vector<RayRow>& rows) {
  return std::any_of(rows.begin(), rows.end(),
                     [](const RayRow& row) { return row.sky[0] + row.sky[1] > 0; });
}

}  // namespace

FormFactors rayFactors(const PatchMesh& mesh, const RayScene& scene,
                       std::vector<KnownRow> rows_known, const RayEstimate& estimate,
                       const FormFactorOptions& options, Progress& progress, RowJournal* journal,
                       Processes* processes) {
  const std::size_t n = scene.size();
  FormFactors result;
  result.method = FactorsFrom::rays;
  FormFactorReport& report = result.report;
  report.polygons = mesh.polygons.size();
  report.estimated_bytes = estimate.memory.bytes;
  const std::shared_ptr<ScratchMemory> scratch = makeRowMemory(estimate.memory, options, n);
  std::vector<double> area(n);
  for (std::size_t k = 0; k < n; ++k) area[scene.order()[k]] = scene.area()[k];
  report.empty_rows = std::size_t(std::count(area.begin(), area.end(), 0.0));
  report.rays.triangles = scene.caster().triangles();
  if (!options.exact_rows.empty()) report.exact_rows = rows_known.size();
  const KnownEntries known(std::move(rows_known), scene.position());

  RayAim aim(options);
  aim.foreseen_rays = estimate.rays;
  std::vector<RayRow> rows =
      castRows(scene, known, aim, report.rays, progress, journal, scratch.get(), processes);
  noteLoosened(options, report);
  report.closed = scene.provedClosed() || !seesSky(rows);
  result.matrix =
      ExchangeMatrix::symmetric(std::move(area), scene.order(), options.storedPrecision(), scratch);
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  result.error.assign(n, 0.0);
  std::vector<double> sky_error(n, 0.0);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  UncertainEntries uncertain(n, scratch);
  const double storing = clockSeconds();
  setAccounts(scene, known, rows, scratch.get(), result, sky_error, seen_backs);
  store(scene, known, rows, options.skyWeight(), scratch.get(), result, uncertain);
  rows = {};
  progress.check();
  const double closing = clockSeconds();
  report.rays.seconds_merge += closing - storing;
  close(uncertain, sky_error, options.closure, result, progress);
  balance(result);
  accountForBacks(mesh, scene.order(), result.matrix.area(), seen_backs, result);
  report.rays.seconds_close = clockSeconds() - closing;
  if (processes != nullptr) share(*processes, progress, result.matrix);
  return result;
}

ExchangeMatrix rayRowsForOthers(const PatchMesh& mesh, std::uint64_t seed, Processes& processes,
                                Progress& progress) {
  castForOthers(processes, RayScene(mesh, seed), progress);
  return receiveRows(processes);
}

}  // namespace radiosity
