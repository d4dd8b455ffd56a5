#include "row_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/row_sample.h"

namespace radiosity::bench {
namespace {

constexpr double kClosedForm = 1e-5;
constexpr double kClosedFormTruth = 1e-9;
constexpr std::size_t kClosedFormRows = 100;

FormFactorOptions exactly(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = tolerance;
  return options;
}

void printRows(const PatchMesh& mesh, const FormFactors& factors, const FormFactors& truth,
               double tolerance) {
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(factors.error[i] > 0)) continue;
    double square = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      const double off = factors.matrix->at(i, j) - truth.matrix->at(i, j);
      square += off * off;
    }
    fmt::print("row {} {} {} {}\n", tolerance, std::sqrt(square), factors.error[i],
               factors.report.exact.recheck_ratio);
  }
}

void printPoints(const PatchMesh& mesh, const ExactReport& report, double tolerance) {
  Progress silent;
  const ExactScene scene(mesh, silent);
  RowSample sample;
  radiosity::sampleRows(scene, tolerance, sample, silent);
  const ExactEstimate estimate = estimateExact(scene, sample, exactly(tolerance));
  fmt::print("points {} {} {} {}\n", tolerance, estimate.occluded_pairs, estimate.points,
             report.points);
}

void printClosedForms(const PatchMesh& mesh) {
  Progress silent;
  const ExactScene scene(mesh, silent);
  const ElementSet& elements = scene.elements;
  const UnoccludedKernel kernel(elements, kClosedForm, true);
  const UnoccludedKernel exact(elements, kClosedFormTruth, true);
  const std::size_t step = std::max<std::size_t>(1, elements.patch_elements / kClosedFormRows);
  for (std::size_t row = 0; row < elements.patch_elements; row += step) {
    double wrong = 0;
    double all = 0;
    for (std::size_t column = 0; column < elements.patch_elements; ++column) {
      if (elements.facet[row] == elements.facet[column]) continue;
      const double truth = exact.pair(Index(row), Index(column));
      const double off = kernel.pair(Index(row), Index(column)) - truth;
      wrong += off * off;
      all += truth * truth;
    }
    if (all > 0) fmt::print("closed {}\n", std::sqrt(wrong / all) / kClosedForm);
  }
}

}  // namespace

void sampleRows(const PatchMesh& mesh, double reference, const std::vector<double>& tolerances) {
  Progress silent;
  const FormFactors truth = computeFormFactors(mesh, exactly(reference), silent);
  for (const double tolerance : tolerances) {
    const FormFactors factors = computeFormFactors(mesh, exactly(tolerance), silent);
    printRows(mesh, factors, truth, tolerance);
    printPoints(mesh, factors.report.exact, tolerance);
  }
  printClosedForms(mesh);
}

}  // namespace radiosity::bench
