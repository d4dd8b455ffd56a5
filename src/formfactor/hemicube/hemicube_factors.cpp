#include "formfactor/hemicube/hemicube_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/figure_text.h"
#include "base/made.h"
#include "base/parallel.h"
#include "formfactor/closed_rows.h"
#include "formfactor/known_entries.h"
#include "formfactor/row_accounts.h"
#include "matrix/estimated_entries.h"
#include "matrix/shared_rows.h"
#include "mesh/patches/canonical_order.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

/// The exchange known beforehand, by patch. Process 0 has it, the others get it.
KnownEntries knownByPatch(std::vector<KnownRow> rows, std::size_t patches, Processes* processes) {
  if (processes != nullptr) {
    std::size_t count = rows.size();
    processes->broadcastValue(count);
    rows.resize(count);
    for (KnownRow& row : rows) {
      processes->broadcastValue(row.patch);
      processes->broadcastArray(row.entries);
      processes->broadcastArray(row.backs);
    }
  }
  std::vector<Index> position(patches);
  std::iota(position.begin(), position.end(), Index(0));
  return {std::move(rows), position};
}

HemicubeReport fillRows(const HemicubeRows& rows, const RowRun& run) {
  HemicubeBlocks blocks(rows, run.progress);
  makeAllRows(blocks, run);
  return blocks.counts();
}

/// Form factors without a matrix yet.
FormFactors emptyAccounts(std::size_t n) {
  FormFactors result;
  for (std::vector<double>* account : {&result.fronts, &result.backs, &result.sky}) {
    account->assign(n, 0.0);
  }
  return result;
}

std::vector<std::uint8_t> flagsOfKnown(const SymmetricMatrix& matrix, const KnownEntries& known) {
  std::vector<std::uint8_t> flags(matrix.size(), 0);
  for (const Index i : matrix.order()) flags[i] = known.rowAt(i) != nullptr ? 1 : 0;
  return flags;
}

/// The errors of the sky of open rows: an eye may miss as much as it may leak. So entries, which
/// are off by more, move where they can.
std::vector<double> skyErrors(const ClosedRows& closed, double smallest, const FormFactors& f) {
  std::vector<double> errors(f.sky.size(), 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (closed.closed(i) || !(f.fronts[i] > 0)) continue;
    errors[i] = std::sqrt(ClosedRows::kMostLeaks * smallest / f.matrix->area()[i]);
  }
  return errors;
}

void symmetrize(std::shared_ptr<const RowMatrix> rows, const KnownEntries& known,
                const ClosedRows& closed, FormFactors& result, Progress& progress) {
  constexpr double kTolerance = 1e-12;
  const auto merged = std::make_shared<SymmetricMatrix>(symmetrized(*rows));
  result.matrix = merged;
  rows.reset();
  // The sums to restore are the raw ones: with backs and, in an open row, the sky they are 1.
  const double smallest = smallestArea(merged->area());
  const std::vector<double> sky_errors = skyErrors(closed, smallest, result);
  result.report.closure =
      closeRows(*merged, estimatedEntries(*merged, flagsOfKnown(*merged, known)), result.fronts,
                progress, kTolerance, {result.sky, sky_errors});
  result.report.symmetrized = true;
  const std::vector<double> sums = merged->rowSums();
  for (std::size_t i = 0; i < sums.size(); ++i) {
    // Keep a sum aimed at: storing rounds those of the matrix.
    if (!closed.closed(i) || !result.report.closure.reached) result.fronts[i] = sums[i];
  }
  closed.balance(result);
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

FormFactors hemicubeFactors(const PatchMesh& mesh, const HemicubeScene& scene,
                            std::vector<KnownRow> known_rows, const FormFactorOptions& options,
                            const RowRun& run) {
  const std::size_t n = mesh.size();
  auto rows = std::make_shared<RowMatrix>(mesh.area, options.storedPrecision(), run.scratch);
  FormFactors result = emptyAccounts(n);
  FormFactorReport& report = result.report;
  report.simd_target = scene.rows.kernels().target;
  const KnownEntries known = knownByPatch(std::move(known_rows), n, run.processes);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  ClosedRows closed(mesh);
  Progress& progress = run.progress;
  report.hemicube = fillRows({scene, known, closed, *rows, result, seen_backs}, run);
  report.empty_rows = n - report.hemicube.hemicubes;
  closed.report(mesh, report);
  result.matrix = wholeMatrix(run.processes, rows, [&progress] { progress.check(); });
  constexpr std::size_t kSteps = 2;
  progress.begin("finishing", kSteps);
  const auto step = [&] {
    progress.advance();
    progress.check();
  };
  accountForBacks(mesh, canonicalOrder(mesh), mesh.area, seen_backs, result);
  checkRows(result);
  step();
  report.reciprocity_residual = reciprocityResidual(pairsOf(*result.matrix));
  step();
  progress.end();
  if (options.symmetrize) symmetrize(std::move(rows), known, closed, result, progress);
  return result;
}

namespace {

/// Exact rows may be this much work for each hemicube and polygon that it looks at: about half of
/// what these take (a hemicube of 256 pixels .15 ms with 17 polygons, .95 ms with 17,672).
constexpr double kExactRowWork = 1e4;
constexpr double kExactRowWorkAPolygon = 2;

class Hemicubes final : public PreparedMethod {
 public:
  Hemicubes(const PatchMesh& mesh, const FormFactorOptions& options)
      : PreparedMethod(FormFactorMethod::hemicube, mesh, options) {}
  /// Hemicubes' own rows come after these.
  std::optional<RoomForExactRows> roomForExactRows() const override {
    const double of_each = kExactRowWork + kExactRowWorkAPolygon * double(mesh().polygons.size());
    return RoomForExactRows{of_each * double(mesh().size()), options().memory_held};
  }

 private:
  Cost foresee(Progress& progress) override;
  FormFactors make(KnownRows exact, const RowRun& run) const override {
    return hemicubeFactors(mesh(), made(scene_), std::move(exact.rows), options(), run);
  }
  std::shared_ptr<const ExchangeMatrix> share(const RowRun& run) const override;

  std::optional<HemicubeScene> scene_;
};

Hemicubes::Cost Hemicubes::foresee(Progress& progress) {
  progress.begin("preparing", 1);
  const HemicubeScene& scene = scene_.emplace(mesh(), options());
  progress.advance();
  progress.end();
  progress.check();
  const HemicubeEstimate estimate = estimateHemicubes(mesh(), scene, options(), progress);
  Cost cost{{}, estimate.memory};
  cost.plan.matrix_bytes = estimate.matrix_bytes;
  cost.plan.seconds = estimate.measured;
  const std::size_t n = mesh().size();
  cost.plan.what = fmt::format("{} {} of {} pixels", countText(n),
                               n == 1 ? "hemicube" : "hemicubes", options().resolution);
  return cost;
}

std::shared_ptr<const ExchangeMatrix> Hemicubes::share(const RowRun& run) const {
  const HemicubeScene scene(mesh(), options());
  auto rows = std::make_shared<RowMatrix>(mesh().area, options().storedPrecision());
  FormFactors result = emptyAccounts(mesh().size());
  std::vector<std::vector<SeenBack>> seen_backs(mesh().size());
  const KnownEntries known = knownByPatch({}, mesh().size(), run.processes);
  ClosedRows closed(mesh());
  fillRows({scene, known, closed, *rows, result, seen_backs}, run);
  return rows;
}

}  // namespace

std::unique_ptr<PreparedMethod> prepareHemicubes(const PatchMesh& mesh,
                                                 const FormFactorOptions& options) {
  return std::make_unique<Hemicubes>(mesh, options);
}

}  // namespace radiosity
