// The mesh: from the scene alone.
#include "base/processes.h"
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

const MeshResult& Pipeline::mesh() {
  options_.mesh.validate();
  const StageKey key = meshKey(options_.mesh, scene());
  if (isMadeBy(key, results_.mesh)) return made(results_.mesh);
  const bool reused = isMadeBy(key, stored_.mesh);
  requireOwnMesh(reused);
  discardFrom(Stage::mesh);
  mesh_reused_ = reused;
  replaces_ = replaces_ || stored_.factors || (stored_.mesh && !mesh_reused_);
  if (mesh_reused_) {
    if (hasOwnMaterials()) results_.materials = std::exchange(stored_.materials, std::nullopt);
    return takeStored(kStage<Stage::mesh>);
  }
  return makeAnew(kStage<Stage::mesh>, key, [this] {
    std::optional<SharedStep> step;
    if (processes_ != nullptr) {
      // The others will need the mesh, too: they make it now, not after this process has planned.
      SharedTask task = SharedTask::mesh;
      processes_->broadcastValue(task);
      step.emplace(*processes_);
    }
    return meshScene(scene(), options_.mesh, progress_);
  });
}

}  // namespace radiosity
