#include "base/hash.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

std::string geometryHash(const PatchMesh& mesh) {
  Hash hash;
  hash.array(mesh.vertices);
  hash.array(mesh.corner_offset);
  hash.array(mesh.corners);
  hash.array(mesh.piece_offset);
  hash.array(mesh.pieces);
  hash.array(mesh.side);
  hash.array(mesh.twin);
  hash.array(mesh.polygon);
  hash.array(mesh.surface);
  hash.array(mesh.polygons.loop_offset);
  hash.array(mesh.polygons.corner_offset);
  hash.array(mesh.polygons.corners);
  hash.array(mesh.polygons.back_is_patch);
  if (mesh.coincidence) hash.bytes(&*mesh.coincidence, sizeof *mesh.coincidence);
  for (const std::string& name : mesh.surface_names) hash.text(name);
  return hash.hex();
}

}  // namespace radiosity
