#include "formfactor/hemicube/hemicube_factors.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/figure_text.h"
#include "base/parallel.h"
#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/kept_row.h"
#include "formfactor/hemicube/row_builder.h"
#include "formfactor/row_accounts.h"
#include "mesh/canonical_order.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

/// What a thread needs to store rows, and what they have counted.
struct RowStore {
  PackedRow row;
  HemicubeRowCounts counts;
};

/// What a thread needs to make them.
struct Worker {
  Hemicube hemicube;
  std::vector<std::uint8_t> hidden;
  RowStore store;
};

/// The rows of one computation.
struct Rows {
  const HemicubeScene& scene;
  RowJournal* journal;
  FormFactors& result;
  std::vector<std::vector<SeenBack>>& seen_backs;
  std::vector<std::uint8_t> made;  ///< by row; empty ones are
};

/// Stores row i as it was seen, or with its near entries put right.
void storeRow(std::size_t i, const HemicubeView& view, const NearPairs* near_pairs, PackedRow& row,
              FormFactors& result, std::vector<SeenBack>& seen_backs, HemicubeRowCounts& counts) {
  const std::size_t n = result.fronts.size();
  row.pack(view, n);
  result.fronts[i] = view.fronts;
  double rest = 1;
  if (near_pairs != nullptr) {
    const NearPairs::Outcome outcome = near_pairs->correct(i, row);
    counts.near_pairs += outcome.replaced;
    counts.capped += outcome.capped;
    rest = outcome.rest;
    result.fronts[i] = std::accumulate(row.values.begin(), row.values.end(), 0.0);
  }
  result.matrix.setRow(i, row.columns, row.values);
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

/// Stores row i and keeps it. `drawn`: what looking at it has counted.
void finishRow(Rows& rows, std::size_t i, const HemicubeView& view, const HemicubeCounts& drawn,
               RowStore& store) {
  HemicubeRowCounts counts;
  const NearPairs* near_pairs = rows.scene.near_pairs ? &*rows.scene.near_pairs : nullptr;
  storeRow(i, view, near_pairs, store.row, rows.result, rows.seen_backs[i], counts);
  counts.drawn = drawn;
  if (rows.journal != nullptr) keepRow(*rows.journal, i, rows.result, rows.seen_backs[i], counts);
  store.counts += counts;
  rows.made[i] = 1;
}

/// Rows that need not be made: empty ones and those in the journal.
HemicubeRowCounts takeRows(Rows& rows, const Progress& progress) {
  tbb::enumerable_thread_specific<HemicubeRowCounts> taken;
  parallelFor(rows.made.size(), 1, [&](std::size_t i) {
    if (progress.cancelled()) return;
    rows.made[i] = rows.scene.rows.isEmpty(i) ||
                   (rows.journal != nullptr &&
                    takeRow(*rows.journal, i, rows.result, rows.seen_backs[i], taken.local()));
  });
  HemicubeRowCounts all;
  for (const HemicubeRowCounts& counts : taken) all += counts;
  return all;
}

/// Rows by the GPU's eye; where that gives up, a note says why and the others are still to be made.
HemicubeRowCounts makeRowsByGpu(Rows& rows, Progress& progress) {
  std::vector<Index> patches;
  for (std::size_t i = 0; i < rows.made.size(); ++i) {
    if (rows.made[i] == 0) patches.push_back(Index(i));
  }
  tbb::enumerable_thread_specific<RowStore> stores;
  const std::string problem = lookFromPatches(
      *rows.scene.gpu, rows.scene.rows, patches,
      [&](std::size_t i, const HemicubeView& view, const HemicubeCounts& drawn) {
        finishRow(rows, i, view, drawn, stores.local());
      },
      progress);
  const std::string& name = rows.scene.gpu->device().name;
  std::vector<Note>& notes = rows.result.report.notes;
  notes.push_back({Severity::info, "hemicubes drawn by " + name});
  if (!problem.empty()) {
    const auto left = std::size_t(std::count(rows.made.begin(), rows.made.end(), 0));
    notes.push_back({Severity::warning, fmt::format("{}: {}; the other {} hemicubes were drawn by "
                                                    "the processor",
                                                    name, problem, countText(left))});
  }
  HemicubeRowCounts all;
  for (const RowStore& store : stores) all += store.counts;
  return all;
}

/// What is left, by the CPU's eye.
HemicubeRowCounts makeRows(Rows& rows, Progress& progress) {
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{rows.scene.rows.makeHemicube(), {}, {}};
  });
  parallelFor(rows.made.size(), 1, [&](std::size_t i) {
    if (progress.cancelled() || rows.made[i] != 0) return;
    Worker& worker = workers.local();
    const HemicubeView& view = rows.scene.rows.look(i, worker.hemicube, worker.hidden);
    finishRow(rows, i, view, worker.hemicube.takeCounts(), worker.store);
    progress.advance();
  });
  HemicubeRowCounts all;
  for (const Worker& worker : workers) all += worker.store.counts;
  return all;
}

void fillRows(const HemicubeScene& scene, RowJournal* journal, FormFactors& result,
              std::vector<std::vector<SeenBack>>& seen_backs, Progress& progress) {
  const std::size_t n = result.fronts.size();
  Rows rows{scene, journal, result, seen_backs, std::vector<std::uint8_t>(n, 0)};
  progress.begin("form factors", n, "rows", rowsThere(scene.rows, n, journal));
  HemicubeRowCounts all = takeRows(rows, progress);
  if (scene.gpu != nullptr) all += makeRowsByGpu(rows, progress);
  all += makeRows(rows, progress);
  progress.check();
  progress.end();

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
    : rows(mesh, options), gpu(openGpuEye(options.eye, rows.scene(), mesh, rows.weights())) {
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
