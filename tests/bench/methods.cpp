#include "methods.h"

namespace radiosity::bench {
namespace {

FormFactors compute(const PatchMesh& mesh, const FormFactorOptions& options) {
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

}  // namespace

Method exact(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = tolerance;
  return {"exact", "tolerance", tolerance,
          [options](const PatchMesh& mesh) { return compute(mesh, options); }};
}

Method rays(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::rays;
  options.tolerance = tolerance;
  return {kRays, "tolerance", tolerance,
          [options](const PatchMesh& mesh) { return compute(mesh, options); }};
}

Method hemicube(int resolution, bool near_exact) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.near_exact = near_exact;
  return {near_exact ? "hemicube + near" : "hemicube", "pixels", double(resolution),
          [options](const PatchMesh& mesh) { return compute(mesh, options); }};
}

std::vector<Method> exactMethods() {
  std::vector<Method> all;
  for (const double tolerance : {1e-1, 1e-2, 3e-3, 1e-3, 1e-4, 1e-5})
    all.push_back(exact(tolerance));
  return all;
}

std::vector<Method> otherMethods(bool quick) {
  std::vector<Method> all;
  for (const bool near_exact : {false, true}) {
    for (const int resolution : {64, 128, 256, 512}) {
      if (!quick || resolution <= 256) all.push_back(hemicube(resolution, near_exact));
    }
  }
  for (const double tolerance : {1e-1, 5e-2, 2e-2, 1e-2, 5e-3}) {
    if (!quick || tolerance >= 2e-2) all.push_back(rays(tolerance));
  }
  return all;
}

}  // namespace radiosity::bench
