#include "methods.h"

#include "cosine_rays.h"

namespace radiosity::bench {
namespace {

FormFactors compute(const PatchMesh& mesh, const FormFactorOptions& options) {
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

}  // namespace

Method hemicube(int resolution, bool near_exact) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.near_exact = near_exact;
  return {near_exact ? "hemicube + near" : "hemicube", "pixels", double(resolution),
          [options](const PatchMesh& mesh) { return compute(mesh, options); }};
}

Method exact(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = tolerance;
  return {"exact", "tolerance", tolerance,
          [options](const PatchMesh& mesh) { return compute(mesh, options); }};
}

Method rays(std::uint32_t count) {
  return {"rays", "rays a patch", double(count),
          [count](const PatchMesh& mesh) { return castFormFactors(mesh, count); }};
}

std::vector<Method> methods(std::size_t patches, bool quick) {
  std::vector<Method> all;
  for (const bool near_exact : {false, true}) {
    for (const int resolution : {64, 128, 256, 512}) {
      if (!quick || resolution <= 256) all.push_back(hemicube(resolution, near_exact));
    }
  }
  for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) all.push_back(exact(tolerance));
  // At 10 to 20 million rays a second: about half a minute for the dearest point, or seconds.
  const double most_rays = quick ? 4e7 : 4e8;
  for (std::uint32_t count = 256; double(count) * double(patches) <= most_rays; count *= 4) {
    all.push_back(rays(count));
  }
  return all;
}

}  // namespace radiosity::bench
