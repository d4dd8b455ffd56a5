// Parts shared by the mesh writers.
#pragma once

#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Wavefront OBJ: outlines, one object a surface.
void writeObj(const std::string& path, const PatchMesh& mesh);
/// glTF 2.0 binary: triangles, one node a surface, flat.
void writePlainGlb(const std::string& path, const PatchMesh& mesh);

/// False for the back of a patch whose front is there as well: the same outline once more.
inline bool isOwnSheet(const PatchMesh& mesh, std::size_t i) {
  return mesh.side[i] == 0 || mesh.twin[i] == kNone;
}

/// Patches by surface, in mesh order, that `wanted(i)` keeps.
template <class Wanted>
std::vector<std::vector<Index>> patchesBySurface(const PatchMesh& mesh, const Wanted& wanted) {
  std::vector<std::vector<Index>> patches(mesh.surface_names.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (wanted(i)) patches[mesh.surface[i]].push_back(Index(i));
  }
  return patches;
}

}  // namespace radiosity
