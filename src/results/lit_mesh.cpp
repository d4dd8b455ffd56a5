#include "results/lit_mesh.h"

#include <fmt/format.h>

#include "base/file_name.h"
#include "base/finite.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

void requireFinite(const LitMesh& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Vec3& colour : mesh.colours[t]) {
      if (isFinite(colour)) continue;
      throw InputError(fmt::format("{}: face {} has a colour that is not a number; export it again",
                                   mesh.file, mesh.face[t]));
    }
  }
}

}  // namespace

void appendLitFace(LitMesh& mesh, std::span<const Index> corners, std::span<const Vec3> colours,
                   Index surface) {
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    mesh.triangles.push_back({corners[0], corners[k], corners[k + 1]});
    mesh.colours.push_back({colours[0], colours[k], colours[k + 1]});
    mesh.face.push_back(Index(mesh.face_surface.size()));
  }
  mesh.face_surface.push_back(surface);
}

LitMesh readLitMesh(const std::string& path) {
  const std::string extension = lowerExtension(path);
  LitMesh mesh;
  if (extension == ".glb" || extension == ".gltf") {
    mesh = readLitGltf(path);
  } else if (extension == ".ply") {
    mesh = readLitPly(path);
  } else if (extension == ".obj") {
    mesh = readLitObj(path);
  } else {
    throw InputError(fmt::format(
        "{}: '{}' is no mesh with vertex colours that is read; export .glb, .ply or .obj", path,
        extension));
  }
  if (mesh.triangles.empty()) {
    throw InputError(path + ": has no faces; export the surfaces, not points or lines");
  }
  requireFinite(mesh);
  return mesh;
}

}  // namespace radiosity
