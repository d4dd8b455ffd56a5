#include "methods.h"

#include "cosine_rays.h"

namespace radiosity::bench {
namespace {

FormFactors compute(const PatchMesh& mesh, const FormFactorOptions& options) {
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

Method rays(std::uint32_t count, bool both_ends) {
  return {both_ends ? kRaysBothEnds : kRays, "rays a patch", double(count),
          [=](const PatchMesh& mesh) { return castFormFactors(mesh, count, both_ends); }};
}

}  // namespace

Method exact(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = tolerance;
  return {"exact", "tolerance", tolerance,
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

std::vector<Method> otherMethods(std::size_t patches, bool quick) {
  std::vector<Method> all;
  for (const bool near_exact : {false, true}) {
    for (const int resolution : {64, 128, 256, 512}) {
      if (!quick || resolution <= 256) all.push_back(hemicube(resolution, near_exact));
    }
  }
  // At 10 to 20 million rays a second: some ten seconds for the dearest point, or a few.
  const double most_rays = quick ? 4e7 : 2e8;
  for (const bool both_ends : {false, true}) {
    for (std::uint32_t count = 256; double(count) * double(patches) <= most_rays; count *= 4) {
      all.push_back(rays(count, both_ends));
    }
  }
  return all;
}

}  // namespace radiosity::bench
