// Meshed scenes with materials, for tests of gathered light.
#pragma once

#include <string>
#include <vector>

#include "radiosity/gather.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace radiosity::test {

struct Room {
  PatchMesh mesh;
  PatchMaterials materials;
};

inline Room roomOf(const Scene& scene, std::size_t patches) {
  Progress quiet;
  MeshOptions options;
  options.patches = patches;
  Room room;
  room.mesh = meshScene(scene, options, quiet).mesh;
  room.materials = patchMaterials(scene, room.mesh);
  return room;
}

/// A scene of data/, by name.
inline Room loadRoom(const std::string& name, std::size_t patches) {
  return roomOf(loadScene(std::string(RADIOSITY_SOURCE_DIR "/data/") + name + ".obj"), patches);
}

/// The same reflectance and emission all over.
inline void makeUniform(Room& room, double reflectance, double emission) {
  const std::size_t count = room.mesh.size() * std::size_t(room.materials.bands);
  room.materials.reflectance.assign(count, reflectance);
  room.materials.emission.assign(count, emission);
}

inline Gathered gathered(const Room& room, const GatherOptions& options) {
  Progress quiet;
  return gather(room.mesh, room.materials, options, quiet);
}

}  // namespace radiosity::test
