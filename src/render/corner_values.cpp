// Computes values at the corners of patches, shared by smooth neighbours, from values of patches.
#include "base/parallel.h"
#include "radiosity/render.h"

namespace radiosity {
namespace {

/// The area-weighted mean over a group's patches, each once. It averages differences to the first,
/// so that a constant keeps its bits.
double groupMean(const PatchMesh& mesh, std::span<const Index> patches,
                 std::span<const double> values, std::size_t bands, std::size_t band) {
  const auto value = [&](Index patch) { return values[patch * bands + band]; };
  const double base = value(patches.front());
  double area = 0;
  double sum = 0;
  Index last = kNone;
  for (const Index patch : patches) {
    if (patch == last) continue;
    last = patch;
    area += mesh.area[patch];
    sum += mesh.area[patch] * (value(patch) - base);
  }
  return area > 0 ? base + sum / area : base;
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
