#include "results/mesh_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <unordered_map>

#include "base/file_name.h"
#include "radiosity/results.h"
#include "results/checked_file.h"
#include "results/glb.h"

namespace radiosity {

namespace {

/// A name without line breaks: in an OBJ file a line break would start a statement.
std::string oneLine(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < 0x20; }, '_');
  return name.empty() ? "_" : name;
}

/// Appends the statements from which a reader makes the surface "object/material" again. Without a
/// slash, object and material have the same name.
void appendSurface(const std::string& name, fmt::memory_buffer& text) {
  const std::size_t slash = name.rfind('/');
  const std::string material = slash == std::string::npos ? name : name.substr(slash + 1);
  fmt::format_to(std::back_inserter(text), "o {}\nusemtl {}\n", oneLine(name.substr(0, slash)),
                 oneLine(material));
}

}  // namespace

void writeObj(const std::string& path, const PatchMesh& mesh) {
  CheckedFile file(path);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  const auto twins =
      std::count_if(mesh.twin.begin(), mesh.twin.end(), [](Index twin) { return twin != kNone; }) /
      2;
  fmt::format_to(
      out,
      "# Patches by radiosity, in metres: face k is patch k, counted from 1.\n"
      "# {} patches are two-sided: one face, their backs are the patches after the fronts.\n",
      twins);
  for (const Vec3& v : mesh.vertices) {
    fmt::format_to(out, "v {} {} {}\n", v.x, v.y, v.z);  // the shortest exact text
  }
  Index surface = kNone;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!isOwnSheet(mesh, i)) continue;
    if (mesh.surface[i] != surface) {
      surface = mesh.surface[i];
      appendSurface(mesh.surface_names[surface], text);
    }
    text.push_back('f');
    for (const Index v : mesh.outline(i)) fmt::format_to(out, " {}", std::size_t(v) + 1);
    text.push_back('\n');
  }
  file.write(text.data(), text.size());
  file.commit();
}

void writePlainGlb(const std::string& path, const PatchMesh& mesh) {
  GlbWriter glb(floatOrigin(mesh.vertices));
  // Without normals readers shade flat, as the specification requires (glTF 2.0, 3.7.2.1).
  std::array<int, 2> materials{};
  for (const bool two_sided : {false, true}) {
    materials[two_sided ? 1 : 0] = glb.addMaterial({{"name", two_sided ? "two-sided" : "one-sided"},
                                                    {"doubleSided", two_sided},
                                                    {"pbrMetallicRoughness",
                                                     {{"baseColorFactor", {0.8, 0.8, 0.8, 1.0}},
                                                      {"metallicFactor", 0.0},
                                                      {"roughnessFactor", 1.0}}}});
  }
  const auto by_surface =
      patchesBySurface(mesh, [&](std::size_t i) { return isOwnSheet(mesh, i); });
  for (std::size_t s = 0; s < by_surface.size(); ++s) {
    std::unordered_map<Index, Index> local;
    std::vector<Index> triangles;
    GlbVertices vertices;
    bool two_sided = false;
    for (const Index i : by_surface[s]) {
      two_sided = two_sided || mesh.twin[i] != kNone;
      for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
        for (const Index v : mesh.pieces[t]) {
          const auto [place, is_new] = local.try_emplace(v, Index(vertices.count()));
          if (is_new) glb.addPosition(vertices, mesh.vertices[v]);
          triangles.push_back(place->second);
        }
      }
    }
    if (triangles.empty()) continue;
    glb.addNode(mesh.surface_names[s],
                {glb.addPrimitive(vertices, triangles, materials[two_sided ? 1 : 0])});
  }
  glb.write(path);
}

void writeMesh(const std::string& path, const PatchMesh& mesh) {
  const std::string extension = lowerExtension(path);
  if (extension == ".obj") {
    writeObj(path, mesh);
  } else if (extension == ".glb") {
    writePlainGlb(path, mesh);
  } else {
    throw InputError(
        fmt::format("{}: '{}' is no mesh format; name a file .obj or .glb", path, extension));
  }
}

}  // namespace radiosity
