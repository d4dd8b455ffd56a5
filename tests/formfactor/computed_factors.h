// Form factors of a mesh, for the tests of the methods.
#pragma once

#include "radiosity/form_factors.h"

namespace radiosity::test {

inline FormFactorOptions exactly(double tolerance = 1e-3) {
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = tolerance;
  return options;
}

inline FormFactors computed(const PatchMesh& mesh, const FormFactorOptions& options = exactly()) {
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

inline FormFactors exactInDouble(const PatchMesh& mesh, double tolerance = 1e-3) {
  FormFactorOptions options = exactly(tolerance);
  options.precision = Precision::double_precision;
  return computed(mesh, options);
}

}  // namespace radiosity::test
