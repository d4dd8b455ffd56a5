// The mesh: from the scene alone.
#include "base/hash.h"
#include "base/processes.h"
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

namespace {

/// Has all properties of the scene that meshing uses: vertices, faces, surfaces with their sides,
/// and which surfaces emit (an emitter wins a coplanar overlap).
std::string sceneHash(const Scene& scene) {
  Hash hash;
  hash.array(scene.vertices);
  hash.array(scene.face_offset);
  hash.array(scene.corners);
  hash.array(scene.face_surface);
  for (const Surface& surface : scene.surfaces) {
    hash.text(surface.name);
    const Material& material = scene.materials[surface.material];
    const bool emits = material.emission != Vec3(0.0);
    hash.text(onOff(material.two_sided) + onOff(emits));
  }
  return hash.hex();
}

StageKey meshKey(const MeshOptions& options, const Scene& scene) {
  StageKey key(keyText(options));
  key.add("scene", sceneHash(scene));
  return key;
}

}  // namespace

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

std::string keyOfMesh(const MeshOptions& options, const Scene& scene) {
  return meshKey(options, scene).text();
}

}  // namespace radiosity
