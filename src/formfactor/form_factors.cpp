#include "radiosity/form_factors.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "formfactor/row_builder.h"

namespace radiosity {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;
/// Share of the view on bare backs above which normals are suspect.
constexpr double kSuspectBacks = 1e-3;

/// Bare backs one row saw.
struct SeenBack {
  Index surface;
  double share;
};

struct Worker {
  Hemicube hemicube;
  std::vector<std::uint8_t> hidden;
  PackedRow row;
};

void refuseTooLarge(const FormFactorReport& report, const FormFactorOptions& options,
                    std::size_t n) {
  if (options.memory_limit == 0 || report.estimated_bytes <= options.memory_limit) return;
  throw RunError(fmt::format(
      "form factors of {} patches need about {:.0f} MiB, more than the limit of {:.0f} MiB; mesh "
      "with fewer patches, use single precision or raise the limit",
      n, double(report.estimated_bytes) / kMebibyte, double(options.memory_limit) / kMebibyte));
}

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

/// Patches by surface name and index within the surface: sums in this order do not depend on how
/// patches are numbered.
std::vector<Index> canonicalOrder(const PatchMesh& mesh) {
  std::vector<Index> order(mesh.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tie(mesh.surface_names[mesh.surface[a]], mesh.index_in_surface[a], mesh.side[a]) <
           std::tie(mesh.surface_names[mesh.surface[b]], mesh.index_in_surface[b], mesh.side[b]);
  });
  return order;
}

void accountForBacks(const PatchMesh& mesh, const std::vector<std::vector<SeenBack>>& seen_backs,
                     FormFactors& result) {
  result.backs_by_surface.assign(mesh.surface_names.size(), 0.0);
  double area = 0;
  for (const Index i : canonicalOrder(mesh)) {
    if (result.fronts[i] + result.backs[i] + result.sky[i] > 0) area += mesh.area[i];
    for (const SeenBack& seen : seen_backs[i]) {
      result.backs_by_surface[seen.surface] += mesh.area[i] * seen.share;
    }
  }
  if (!(area > 0)) return;
  for (double& share : result.backs_by_surface) share /= area;
}

void noteBacks(const PatchMesh& mesh, FormFactors& result) {
  const std::vector<double>& share = result.backs_by_surface;
  const double total = std::accumulate(share.begin(), share.end(), 0.0);
  if (!(total > kSuspectBacks)) return;
  std::vector<std::size_t> worst(share.size());
  std::iota(worst.begin(), worst.end(), std::size_t(0));
  std::stable_sort(worst.begin(), worst.end(),
                   [&](std::size_t a, std::size_t b) { return share[a] > share[b]; });
  std::string names;
  for (const std::size_t s : worst) {
    // Name what makes up the warning, not every sliver.
    if (share[s] < 0.1 * total) break;
    names += fmt::format("{}{} ({:.2f}%)", names.empty() ? "" : ", ", mesh.surface_names[s],
                         100 * share[s]);
  }
  result.report.notes.push_back(
      {Severity::warning,
       fmt::format("{:.2f}% of the view ends on bare backs, seen from behind: {}; flipped? "
                   "(turn the faces over, or make them two-sided)",
                   100 * total, names)});
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

void FormFactorOptions::validate() const {
  if (resolution < 16 || resolution > 4096 || resolution % 2 != 0) {
    throw InputError(fmt::format(
        "hemicube resolution {}: give an even number of pixels from 16 to 4096", resolution));
  }
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  const std::size_t n = mesh.size();
  const RowBuilder rows(mesh, options);
  FormFactors result;
  FormFactorReport& report = result.report;
  report.polygons = mesh.polygons.size();
  report.simd_target = rows.kernels().target;
  report.estimated_bytes = estimateBytes(mesh, options, rows);
  refuseTooLarge(report, options, n);

  result.matrix = ExchangeMatrix(mesh.area, options.precision);
  result.fronts.assign(n, 0.0);
  result.backs.assign(n, 0.0);
  result.sky.assign(n, 0.0);
  std::vector<std::vector<SeenBack>> seen_backs(n);
  fillRows(rows, result, seen_backs, progress);
  accountForBacks(mesh, seen_backs, result);
  noteBacks(mesh, result);
  checkRows(result);
  report.reciprocity_residual = reciprocityResidual(result.matrix);
  if (options.symmetrize) symmetrize(result);
  report.matrix_bytes = result.matrix.bytes();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::size_t estimateFormFactorBytes(const PatchMesh& mesh, const FormFactorOptions& options) {
  options.validate();
  return estimateBytes(mesh, options, RowBuilder(mesh, options));
}

}  // namespace radiosity
