// Direct light, then indirect light in passes.
#include "radiosity/elements.h"

#include <fmt/format.h>

#include <bit>

#include "base/require_within.h"
#include "elements/light_sources.h"

namespace radiosity {

void ElementOptions::validate() const {
  requireWithin("elements: tolerance", tolerance, 1e-4, 0.5);
  requireWithin("elements: smallest_edge", smallest_edge, 1e-5, 0.1);
  requireWithin("elements: crease", crease, 0.0, 180.0);
  requireWithin("elements: rays", rays, 64, 4096);
  if (!std::has_single_bit(unsigned(rays))) {
    throw InputError(fmt::format("elements: rays is {}; it must be a power of two", rays));
  }
  if (most_vertices < 1 || !(most_rays >= 1)) {
    throw InputError("elements: most_vertices and most_rays must be 1 or more");
  }
}

Elements computeElements(const PatchMesh& mesh, const PatchMaterials& materials,
                         std::span<const double> irradiance, const ElementOptions& options,
                         std::span<const std::uint8_t> wanted, Progress& progress) {
  options.validate();
  requireSizes(mesh, materials, irradiance, wanted);
  if (mesh.size() == 0) return {};
  LightSources sources(mesh, materials, irradiance, options, wanted, false, progress);
  Elements out;
  out.bands = materials.bands;
  out.indirect = sources.indirectField();
  out.report = sources.report();
  out.direct = sources.takeDirect();
  out.roots = sources.takeRoots();
  return out;
}

}  // namespace radiosity
