#include "figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "clocks.h"
#include "figure_scenes.h"
#include "methods.h"
#include "truth_rows.h"

namespace radiosity::bench {
namespace {

/// Error of each value of truth aimed at, in mean form factors: a tenth of the least that is
/// scored.
constexpr double kTruthAccuracy = 1e-6;

struct FigureScore {
  std::size_t above = 0;    ///< rows whose error is above their figure
  double worst = 0;         ///< largest error / figure
  double median_ratio = 0;  ///< of figure / error
  double sum_error = 0;     ///< largest difference of a row's sum from that of truth
};

FigureScore scoreFigures(const FormFactors& factors, const TruthRows& truth,
                         const std::vector<double>& error) {
  FigureScore score;
  std::vector<double> ratios;
  for (std::size_t k = 0; k < truth.index.size(); ++k) {
    const Index i = truth.index[k];
    const double figure = factors.error[i];
    if (error[k] > figure) ++score.above;
    if (error[k] > 0) {
      score.worst = std::max(score.worst, error[k] / figure);
      ratios.push_back(figure / error[k]);
    }
    double sum = 0;
    for (const double value : truth.row[k]) sum += value;
    score.sum_error = std::max(score.sum_error, std::abs(factors.fronts[i] - sum));
  }
  if (!ratios.empty()) {
    const auto middle = ratios.begin() + std::ptrdiff_t(ratios.size() / 2);
    std::nth_element(ratios.begin(), middle, ratios.end());
    score.median_ratio = *middle;
  }
  return score;
}

}  // namespace

void benchFigures(const std::string& scene, const std::string& truth_folder) {
  fmt::print("\nError figures on scenes that took no part in their making\n");
  fmt::print("  {:<20} {:>7} {:>5} {:>8} | {:>8} {:>8} | {:>5} {:>7} {:>7} {:>7} | {:>9} | {}\n",
             "scene", "patches", "rows", "setting", "seconds", "relL2(F)", "above", "below",
             "median", "worst", "row sums", "points");
  for (const FigureScene& of : figureScenes()) {
    if (!of.name.starts_with(scene)) continue;
    Progress silent;
    MeshOptions options;
    options.patches = of.patches;
    const PatchMesh mesh = meshScene(of.make(), options, silent).mesh;
    setThreads(0);
    const TruthRows truth = truthRows(mesh, kTruthAccuracy, truth_folder);
    for (const Method& method : exactMethods()) {
      setThreads(1);
      const Stopwatch watch;
      const FormFactors factors = method.compute(mesh);
      const Seconds seconds = watch.elapsed();
      const MatrixError error = matrixError(pairsOf(*factors.matrix), truth);
      const FigureScore score = scoreFigures(factors, truth, error.row);
      fmt::print(
          "  {:<20} {:>7} {:>5} {:>8.0e} | {:>8.3f} {:>8.1e} | {:>5} {:>6.1f}% {:>7.1f} {:>7.2f} | "
          "{:>9.1e} | {}\n",
          of.name, mesh.size(), truth.index.size(), method.value, seconds.processor(),
          error.relative_l2, score.above,
          100.0 * (1 - double(score.above) / double(truth.index.size())), score.median_ratio,
          score.worst, score.sum_error, factors.report.exact.points);
      std::fflush(stdout);
    }
  }
  setThreads(0);
}

}  // namespace radiosity::bench
