// Gathered light: from the mesh and materials.
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

const Gathered& Pipeline::gathered() {
  const PatchMesh& patches = mesh().mesh;
  options_.gather.validate();
  const PatchMaterials& materials = materialsOfMesh();
  StageKey key(keyText(options_.gather));
  key.add("materials", materialsHash(materials));
  key.add("sky", lightsText(materials.lights));
  key.add("mesh", geometryHash(patches));
  return getOrMake(kStage<Stage::gather>, key, [&] {
    return computedStage("gathering",
                         [&] { return gather(patches, materials, options_.gather, progress_); });
  });
}

}  // namespace radiosity
