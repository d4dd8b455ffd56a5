// Computes values at the corners of patches, shared by smooth neighbours, from values of patches.
#include "base/parallel.h"
#include "base/steady_mean.h"
#include "radiosity/render.h"

namespace radiosity {
namespace {

/// The area-weighted mean over a group's patches, each once.
double groupMean(const PatchMesh& mesh, std::span<const Index> patches,
                 std::span<const double> values, std::size_t bands, std::size_t band) {
  SteadyMean mean;
  Index last = kNone;
  for (const Index patch : patches) {
    if (patch != last) mean.add(mesh.area[patch], values[patch * bands + band]);
    last = patch;
  }
  return mean.value();
}

}  // namespace

std::vector<double> cornerValues(const PatchMesh& mesh, std::span<const double> values, int bands,
                                 double crease) {
  if (bands < 1 || values.size() != mesh.size() * std::size_t(bands)) {
    throw InputError("cornerValues: " + std::to_string(bands) + " values a patch are needed, " +
                     std::to_string(values.size()) + " were given for " +
                     std::to_string(mesh.size()) + " patches");
  }
  const auto width = std::size_t(bands);
  std::vector<double> result(mesh.corners.size() * width);
  const CornerGroups groups = cornerGroups(mesh, crease);
  constexpr std::size_t kGrain = 256;
  parallelFor(groups.size(), kGrain, [&](std::size_t g) {
    for (std::size_t b = 0; b < width; ++b) {
      const double mean = groupMean(mesh, groups.patchesOf(g), values, width, b);
      for (const std::size_t corner : groups.cornersOf(g)) result[corner * width + b] = mean;
    }
  });
  return result;
}

}  // namespace radiosity
