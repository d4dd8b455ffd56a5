#include "radiosity/form_factors.h"

#include <fmt/format.h>

#include <chrono>

#include "formfactor/hemicube_factors.h"

namespace radiosity {

void FormFactorOptions::validate() const {
  if (resolution < 16 || resolution > 4096 || resolution % 2 != 0) {
    throw InputError(fmt::format(
        "hemicube resolution {}: give an even number of pixels from 16 to 4096", resolution));
  }
  if (!(tolerance >= 1e-12 && tolerance <= 0.1)) {
    throw InputError(fmt::format(
        "tolerance {}: give a fraction of the mean form factor from 1e-12 to 0.1", tolerance));
  }
}

Precision FormFactorOptions::storedPrecision() const {
  // Single precision rounds to 6e-8 of a value, well below a tolerance of 1e-6 of the mean.
  return precision.value_or(tolerance < 1e-6 ? Precision::real : Precision::single);
}

FormFactorPlan planFormFactors(const PatchMesh& mesh, const FormFactorOptions& options) {
  options.validate();
  return {FormFactorMethod::hemicube, "", hemicubeBytes(mesh, options)};
}

FormFactors computeFormFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                               Progress& progress) {
  options.validate();
  const auto start = std::chrono::steady_clock::now();
  FormFactors result = hemicubeFactors(mesh, options, progress);
  FormFactorReport& report = result.report;
  report.matrix_bytes = result.matrix.bytes();
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace radiosity
