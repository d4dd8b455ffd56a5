// Random numbers of a patch: the same whatever the numbering of patches.
#pragma once

#include <cstdint>

#include "base/hash.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// 64 well-mixed bits that depend on the patch's identity (surface name, index in the surface,
/// side) and on `seed`.
inline std::uint64_t patchSeed(const PatchMesh& mesh, std::size_t patch, std::uint64_t seed) {
  Hash hash;
  hash.text(mesh.surface_names[mesh.surface[patch]]);
  hash.bytes(&mesh.index_in_surface[patch], sizeof(Index));
  hash.bytes(&mesh.side[patch], 1);
  hash.bytes(&seed, sizeof seed);
  return mixed(hash.value());  // FNV-1a leaves the last bytes little mixed
}

}  // namespace radiosity
