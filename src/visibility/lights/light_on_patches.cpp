#include "visibility/lights/light_on_patches.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/parallel.h"

namespace radiosity {

std::vector<double> lightOnPatches(std::span<const Light> lights, const PatchMesh& mesh,
                                   std::span<const double> open, int bands) {
  if (!open.empty() && open.size() != mesh.unknowns()) {
    throw InputError(fmt::format("lights: {} shares of the sky where the mesh takes {}",
                                 open.size(), mesh.unknowns()));
  }
  const auto width = std::size_t(bands);
  std::vector<double> irradiance(mesh.size() * width, 0.0);
  parallelFor(mesh.size(), 1024, [&](std::size_t i) {
    LitPlace place{mesh.centroid[i], mesh.normal[i]};
    if (!open.empty()) place.open = std::max(0.0, open[mesh.unknownOf(i)]);
    for (const Light& light : lights) {
      for (std::size_t b = 0; b < width; ++b) {
        irradiance[i * width + b] += light.irradiance(b, place);
      }
    }
  });
  return irradiance;
}

}  // namespace radiosity
