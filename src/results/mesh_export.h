// Functions that all mesh writers use.
#pragma once

#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Writes Wavefront OBJ: outlines, one object a surface.
void writeObj(const std::string& path, const PatchMesh& mesh);
/// Writes glTF 2.0 binary: triangles, one node a surface, flat.
void writePlainGlb(const std::string& path, const PatchMesh& mesh);

/// False for the back of a patch whose front is in the mesh as well, since it has the same outline.
inline bool isOwnSheet(const PatchMesh& mesh, std::size_t i) {
  return mesh.side[i] == 0 || mesh.twin[i] == kNone;
}

/// The patches with `wanted(i)`, by surface, in mesh order.
template <class Wanted>
std::vector<std::vector<Index>> patchesBySurface(const PatchMesh& mesh, const Wanted& wanted) {
  std::vector<std::vector<Index>> patches(mesh.surface_names.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (wanted(i)) patches[mesh.surface[i]].push_back(Index(i));
  }
  return patches;
}

}  // namespace radiosity
