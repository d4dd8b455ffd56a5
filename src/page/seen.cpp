#include "page/seen.h"

#include <algorithm>
#include <cmath>

#include "formfactor/rays/seen_patches.h"

namespace radiosity::page {

namespace {

/// Codes 1 to 65,535 stand for -scale to scale.
constexpr int kZero = 32768;
constexpr double kSteps = 32767;

struct AxisCodes {
  std::vector<std::uint16_t> code;  ///< of SeenPatches::mean
  std::vector<float> scale;         ///< cluster by cluster, of each axis: its largest value
};

AxisCodes encode(const SeenPatches& seen) {
  AxisCodes codes;
  codes.code.resize(seen.mean.size());
  std::size_t first = 0;
  for (std::size_t k = 0; k < seen.axes.size(); ++k) {
    const std::size_t axes = seen.axes[k];
    const std::size_t end = first + axes * (seen.begin[k + 1] - seen.begin[k]);
    for (std::size_t a = 0; a < axes; ++a) {
      float scale = 0;
      for (std::size_t at = first + a; at < end; at += axes) {
        scale = std::max(scale, std::abs(seen.mean[at]));
      }
      codes.scale.push_back(scale);
      for (std::size_t at = first + a; scale > 0 && at < end; at += axes) {
        codes.code[at] =
            std::uint16_t(kZero + std::lround(kSteps * double(seen.mean[at]) / double(scale)));
      }
    }
    first = end;
  }
  return codes;
}

}  // namespace

void addSeenPatches(const PatchMesh& mesh, Progress& progress, Container& container) {
  const SeenPatches seen = mesh.clusters ? seenPatches(mesh, progress) : SeenPatches();
  const AxisCodes codes = encode(seen);
  container.add("seen_begin", seen.begin);
  container.add("seen_item", seen.item);
  container.add("seen_hits", std::vector<std::uint16_t>(seen.hits.begin(), seen.hits.end()));
  container.add("seen_rays", seen.rays);
  container.add("seen_axes", seen.axes);
  container.add("seen_axis_code", codes.code);
  container.add("seen_axis_scale", codes.scale);
  container.add("patch_axis", seen.patch);
}

}  // namespace radiosity::page
