#include "formfactor/hemicube_factors.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "formfactor/row_accounts.h"
#include "formfactor/row_builder.h"

namespace radiosity {
namespace {

struct Worker {
  Hemicube hemicube;
  std::vector<std::uint8_t> hidden;
  PackedRow row;
};

void fillRows(const RowBuilder& rows, FormFactors& result,
              std::vector<std::vector<SeenBack>>& seen_backs, Progress& progress) {
  const std::size_t n = result.fronts.size();
  tbb::enumerable_thread_specific<Worker> workers([&] {
    return Worker{rows.makeHemicube(), {}, {}};
  });
  progress.begin("form factors", n);
  parallelFor(n, 1, [&](std::size_t i) {
    if (progress.cancelled()) return;
    if (!rows.isEmpty(i)) {
      Worker& worker = workers.local();
      const HemicubeView& view = rows.look(i, worker.hemicube, worker.hidden);
      worker.row.pack(view, n);
      result.matrix.setRow(i, worker.row.columns, worker.row.values);
      result.fronts[i] = view.fronts;
      result.backs[i] = view.backs;
      result.sky[i] = view.sky;
      for (std::size_t item = n; view.backs > 0 && item < view.items.size(); ++item) {
        if (view.items[item] > 0) seen_backs[i].push_back({Index(item - n), view.items[item]});
      }
    }
    progress.advance();
  });
  progress.check();
  progress.end();

  HemicubeCounts counts;
  for (const Worker& worker : workers) counts += worker.hemicube.counts();
  FormFactorReport& report = result.report;
  report.hemicubes = counts.hemicubes;
  report.empty_rows = n - counts.hemicubes;
  report.rasterised_polygons = counts.rasterised_polygons;
  report.skipped_own_plane = counts.skipped_own_plane;
  report.skipped_horizon = counts.skipped_horizon;
  report.skipped_facing_away = counts.skipped_facing_away;
  report.skipped_face = counts.skipped_face;
  report.pixels = counts.pixels;
  report.closed = counts.hemicubes > 0 && counts.sky_pixels == 0;
}

void symmetrize(FormFactors& result) {
  // The row sums to restore are the raw ones: 1 in a closed scene, what was seen in an open one.
  result.matrix = symmetrized(result.matrix);
  result.report.closure = restoreClosure(result.matrix, result.fronts);
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

FormFactors hemicubeFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                            Progress& progress) {
  const std::size_t n = mesh.size();
  const RowBuilder rows(mesh, options);
  FormFactors result;
  result.method = "hemicube";
  FormFactorReport& report = result.report;
  report.polygons = mesh.polygons.size();
  report.simd_target = rows.kernels().target;
  report.estimated_bytes = estimateBytes(mesh, options, rows);
  refuseTooLarge(report.estimated_bytes, options, n);

  result.matrix = ExchangeMatrix(mesh.area, options.storedPrecision());
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  fillRows(rows, result, seen_backs, progress);
  accountForBacks(mesh, seen_backs, result);
  checkRows(result);
  report.reciprocity_residual = reciprocityResidual(result.matrix);
  if (options.symmetrize) symmetrize(result);
  return result;
}

std::size_t hemicubeBytes(const PatchMesh& mesh, const FormFactorOptions& options) {
  return estimateBytes(mesh, options, RowBuilder(mesh, options));
}

}  // namespace radiosity
