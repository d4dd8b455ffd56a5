#include "formfactor/hemicube/hemicube_factors.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "formfactor/hemicube/kept_row.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/row_accounts.h"
#include "mesh/canonical_order.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

struct Worker {
  Hemicube hemicube;
  std::vector<std::uint8_t> hidden;
  PackedRow row;
  HemicubeRowCounts counts;  ///< of all its rows
};

/// Stores row i as it was seen, or with its near entries put right.
void storeRow(std::size_t i, const HemicubeView& view, const NearPairs* near_pairs, Worker& worker,
              FormFactors& result, std::vector<SeenBack>& seen_backs, HemicubeRowCounts& counts) {
  const std::size_t n = result.fronts.size();
  worker.row.pack(view, n);
  result.fronts[i] = view.fronts;
  double rest = 1;
  if (near_pairs != nullptr) {
    const NearPairs::Outcome outcome = near_pairs->correct(i, worker.row);
    counts.near_pairs += outcome.replaced;
    counts.capped += outcome.capped;
    rest = outcome.rest;
    const std::vector<double>& values = worker.row.values;
    result.fronts[i] = std::accumulate(values.begin(), values.end(), 0.0);
  }
  result.matrix.setRow(i, worker.row.columns, worker.row.values);
  result.backs[i] = rest * view.backs;
  result.sky[i] = rest * view.sky;
  for (std::size_t item = n; view.backs > 0 && item < view.items.size(); ++item) {
    if (view.items[item] > 0) seen_backs.push_back({Index(item - n), rest * view.items[item]});
  }
}

/// How many rows need not be made: those that are empty, and those in the journal.
std::size_t rowsThere(const RowBuilder& rows, std::size_t n, RowJournal* journal) {
  std::size_t found = 0;
  std::size_t all = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (rows.isEmpty(i)) continue;
    ++all;
    found += journal != nullptr && journal->has(RowBlock::hemicube_row, i) ? 1 : 0;
  }
  if (journal != nullptr) journal->found(found, all);
  return n - all + found;
}

/// Makes row i and keeps it.
void makeRow(const HemicubeScene& scene, std::size_t i, RowJournal* journal, Worker& worker,
             FormFactors& result, std::vector<SeenBack>& seen_backs) {
  HemicubeRowCounts counts;
  const HemicubeView& view = scene.rows.look(i, worker.hemicube, worker.hidden);
  storeRow(i, view, scene.near_pairs ? &*scene.near_pairs : nullptr, worker, result, seen_backs,
           counts);
  counts.drawn = worker.hemicube.takeCounts();
  if (journal != nullptr) keepRow(*journal, i, result, seen_backs, counts);
  worker.counts += counts;
}

void fillRows(const HemicubeScene& scene, RowJournal* journal, FormFactors& result,
              std::vector<std::vector<SeenBack>>& seen_backs, Progress& progress) {
  const RowBuilder& rows = scene.rows;
  const std::size_t n = result.fronts.size();
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{rows.makeHemicube(), {}, {}, {}};
  });
  progress.begin("form factors", n, "rows", rowsThere(rows, n, journal));
  parallelFor(n, 1, [&](std::size_t i) {
    if (progress.cancelled() || rows.isEmpty(i)) return;
    Worker& worker = workers.local();
    if (journal != nullptr && takeRow(*journal, i, result, seen_backs[i], worker.counts)) return;
    makeRow(scene, i, journal, worker, result, seen_backs[i]);
    progress.advance();
  });
  progress.check();
  progress.end();

  HemicubeRowCounts all;
  for (const Worker& worker : workers) all += worker.counts;
  const HemicubeCounts& counts = all.drawn;
  FormFactorReport& report = result.report;
  report.near_pairs = all.near_pairs;
  report.capped = all.capped;
  report.hemicubes = counts.hemicubes;
  report.empty_rows = n - counts.hemicubes;
  report.rasterised_polygons = counts.rasterised_polygons;
  report.skipped_own_plane = counts.skipped_own_plane;
  report.skipped_horizon = counts.skipped_horizon;
  report.skipped_facing_away = counts.skipped_facing_away;
  report.skipped_face = counts.skipped_face;
  report.skipped_hidden = counts.skipped_hidden;
  report.pixels = counts.pixels;
  report.closed = counts.hemicubes > 0 && counts.sky_pixels == 0;
}

/// How far off the entries of a merged matrix may be: the square of the error goes with the
/// exchange area, as in van Leersum's closure (closure.h). In a unit that keeps errors of F
/// below 1.
UncertainEntries uncertainEntries(const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  double smallest = std::numeric_limits<double>::infinity();
  for (const double a : matrix.area()) smallest = a > 0 ? std::min(smallest, a) : smallest;
  UncertainEntries uncertain(n, matrix.scratch());
  parallelFor(n, 1, [&](std::size_t k) {
    const ExchangeMatrix::UpperEntries upper = matrix.upperEntries(k);
    const double share = smallest / matrix.area()[matrix.order()[k]];
    std::vector<Index> later;
    std::vector<double> errors;
    for (std::size_t m = 0; m < upper.positions.size(); ++m) {
      if (upper.positions[m] == k) continue;
      later.push_back(upper.positions[m]);
      errors.push_back(std::sqrt(upper.factors[m] * share));
    }
    uncertain.setRow(k, later, errors);
  });
  return uncertain;
}

void symmetrize(FormFactors& result, Progress& progress) {
  constexpr double kTolerance = 1e-12;
  result.matrix = symmetrized(result.matrix);
  // The row sums to restore are the raw ones: 1 in a closed scene, what was seen in an open one.
  result.report.closure = closeRows(result.matrix, uncertainEntries(result.matrix), result.fronts,
                                    progress, kTolerance);
  result.report.symmetrized = true;
}

void checkRows(FormFactors& result) {
  for (std::size_t i = 0; i < result.fronts.size(); ++i) {
    const double sum = result.fronts[i] + result.backs[i] + result.sky[i];
    if (sum > 0) {
      result.report.largest_row_error =
          std::max(result.report.largest_row_error, std::abs(sum - 1));
    }
  }
}

}  // namespace

HemicubeScene::HemicubeScene(const PatchMesh& mesh, const FormFactorOptions& options)
    : rows(mesh, options) {
  if (options.near_exact) near_pairs.emplace(mesh, options);
}

FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            const HemicubeEstimate& estimate, const FormFactorOptions& options,
                            Progress& progress, RowJournal* journal) {
  const std::size_t n = mesh.size();
  FormFactors result;
  result.method = "hemicube";
  FormFactorReport& report = result.report;
  report.polygons = mesh.polygons.size();
  report.simd_target = scene.rows.kernels().target;
  report.estimated_bytes = estimate.memory.bytes;
  result.matrix = ExchangeMatrix(mesh.area, options.storedPrecision(),
                                 makeRowMemory(estimate.memory, options, n));
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  fillRows(scene, journal, result, seen_backs, progress);
  constexpr std::size_t kSteps = 2;
  progress.begin("finishing", kSteps);
  const auto step = [&] {
    progress.advance();
    progress.check();
  };
  accountForBacks(mesh, canonicalOrder(mesh), mesh.area, seen_backs, result);
  checkRows(result);
  step();
  report.reciprocity_residual = reciprocityResidual(result.matrix);
  step();
  progress.end();
  if (options.symmetrize) symmetrize(result, progress);
  return result;
}

}  // namespace radiosity
