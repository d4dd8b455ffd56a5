// Gathered light: from the mesh and materials.
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

const Gathered& Pipeline::gathered() {
  const PatchMesh& patches = mesh().mesh;
  options_.gather.validate();
  const PatchMaterials& materials = materialsOfMesh();
  return getOrMake(kStage<Stage::gather>, gatherKey(options_.gather, materials, patches), [&] {
    return computedStage("gathering",
                         [&] { return gather(patches, materials, options_.gather, progress_); });
  });
}

}  // namespace radiosity
