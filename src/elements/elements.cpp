// Direct light, then indirect light in passes.
#include "radiosity/elements.h"

#include "base/option_list.h"
#include "elements/light_sources.h"

namespace radiosity {

void ElementOptions::validate() const { requireRanges(*this); }

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
