#include "error_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lighting.h"
#include "radiosity/row_matrix.h"
#include "report.h"
#include "verify.h"

namespace radiosity::bench {
namespace {

/// Of B, far below the error of any matrix here.
constexpr double kSolveTolerance = 1e-8;

FormFactors asFormFactors(const PatchMesh& mesh, const TruthRows& truth) {
  const auto matrix = std::make_shared<RowMatrix>(mesh.area, Precision::double_precision);
  FormFactors factors;
  factors.matrix = matrix;
  factors.fronts.assign(mesh.size(), 0.0);
  factors.backs.assign(mesh.size(), 0.0);
  factors.sky.assign(mesh.size(), 0.0);
  for (std::size_t k = 0; k < truth.index.size(); ++k) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (Index j = 0; j < mesh.size(); ++j) {
      if (!(truth.row[k][j] > 0)) continue;
      columns.push_back(j);
      values.push_back(truth.row[k][j]);
      factors.fronts[truth.index[k]] += truth.row[k][j];
    }
    matrix->setRow(truth.index[k], columns, values);
  }
  return factors;
}

/// Runs one method, several times if it is quick.
FormFactors timed(const Method& method, const PatchMesh& mesh, Measurement& measurement) {
  FormFactors factors;
  const Timing timing = leastOfRuns([&] {
    factors = {};
    const Stopwatch watch;
    factors = method.compute(mesh);
    return watch.elapsed();
  });
  measurement.seconds = timing.seconds;
  measurement.runs = timing.runs;
  return factors;
}

double largestRowError(const FormFactors& factors) {
  double largest = 0;
  for (std::size_t i = 0; i < factors.fronts.size(); ++i) {
    const double sum = factors.fronts[i] + factors.backs[i] + factors.sky[i];
    if (sum > 0) largest = std::max(largest, std::abs(sum - 1));
  }
  return largest;
}

std::optional<OwnEstimate> ownEstimate(const FormFactors& factors, const TruthRows& truth,
                                       const MatrixError& error) {
  if (factors.error.empty()) return std::nullopt;
  OwnEstimate own;
  own.matrix = factors.report.error_figure;
  std::vector<double> ratios;
  for (std::size_t k = 0; k < truth.index.size(); ++k) {
    const double figure = factors.error[truth.index[k]];
    if (error.row[k] <= figure) own.rows_covered += 1.0 / double(truth.index.size());
    if (error.row[k] > 0) ratios.push_back(figure / error.row[k]);
  }
  if (ratios.empty()) return own;
  const auto middle = ratios.begin() + std::ptrdiff_t(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  own.median_ratio = *middle;
  return own;
}

struct Measured {
  Measurement measurement;
  std::vector<double> radiosity;
};

Measured measure(const Method& method, const PatchMesh& mesh, const TruthRows& truth,
                 const Lighting& lighting) {
  Measured result;
  Measurement& m = result.measurement;
  m.method = method.name;
  m.setting = method.setting;
  m.value = method.value;
  setThreads(1);
  const FormFactors factors = timed(method, mesh, m);
  setThreads(0);
  m.factors = matrixError(pairsOf(*factors.matrix), truth);
  m.bytes = factors.matrix->bytes();
  m.largest_row_error = largestRowError(factors);
  m.own = ownEstimate(factors, truth, m.factors);
  m.exact = factors.report.exact;
  result.radiosity = lighting.solve(factors, kSolveTolerance);
  return result;
}

/// From the loosest setting to the tightest; those that follow one of more than kMostSeconds go to
/// `left_out`.
std::vector<Measured> measureExact(const BenchScene& scene, const TruthRows& truth,
                                   const Lighting& lighting, std::vector<double>& left_out) {
  std::vector<Measured> all;
  for (const Method& method : exactMethods()) {
    if (!all.empty() && all.back().measurement.seconds.processor() > kMostSeconds) {
      left_out.push_back(method.value);
    } else {
      all.push_back(measure(method, scene.mesh, truth, lighting));
    }
  }
  return all;
}

}  // namespace

std::optional<SceneCurves> errorCurves(const BenchScene& scene, const TruthRows& truth,
                                       double truth_accuracy, bool quick) {
  const PatchMesh& mesh = scene.mesh;
  SceneCurves curves;
  curves.scene = scene.name;
  curves.patches = mesh.size();
  curves.polygons = mesh.polygons.size();
  curves.truth_rows = truth.index.size();
  fmt::print("\n{}: {} patches, {} polygons\n", scene.name, mesh.size(), mesh.polygons.size());
  if (!verifyTruth(scene, truth, truth_accuracy)) return std::nullopt;

  const Lighting lighting(scene);
  const std::vector<Measured> exact = measureExact(scene, truth, lighting, curves.left_out);
  std::vector<double> reference;
  if (truth.complete) {
    curves.radiosity_reference = "truth";
    reference = lighting.solve(asFormFactors(mesh, truth), kSolveTolerance);
  } else {
    curves.radiosity_reference = fmt::format("exact {:.0e}", exact.back().measurement.value);
    reference = exact.back().radiosity;
  }
  const auto add = [&](const Measured& measured) {
    Measurement m = measured.measurement;
    if (&measured != &exact.back() || truth.complete) {
      m.radiosity = relativeError(mesh, measured.radiosity, reference);
    }
    printMeasurement(m);
    curves.measurements.push_back(m);
  };
  printCurveHead(curves);
  for (const Measured& measured : exact) add(measured);
  printLeftOut(curves);
  for (const Method& method : otherMethods(quick)) {
    add(measure(method, mesh, truth, lighting));
  }
  return curves;
}

}  // namespace radiosity::bench
