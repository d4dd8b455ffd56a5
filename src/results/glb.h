// glTF 2.0 binary files, written by hand: a JSON chunk and a chunk of float and index arrays.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Where the file's coordinates start: 0, or the middle of the mesh where that is farther from 0
/// than the mesh is long. Positions are 32-bit floats; the rest goes into node translations, which
/// are 64-bit numbers.
Vec3 floatOrigin(const PatchMesh& mesh);

/// Attributes of the vertices of one primitive; colour and value are empty or as many.
struct GlbVertices {
  std::vector<std::array<float, 3>> position;
  std::vector<std::array<float, 3>> colour;     ///< COLOR_0, linear
  std::vector<std::array<float, 3>> radiosity;  ///< _RADIOSITY, W/m^2
  std::size_t count() const { return position.size(); }
};

class GlbWriter {
 public:
  using Json = nlohmann::ordered_json;

  explicit GlbWriter(const Vec3& origin);
  int addMaterial(Json material);
  void useExtension(const std::string& name) { document_["extensionsUsed"].push_back(name); }
  /// Facts about the whole file, where Blender shows them: on the scene.
  void setExtras(Json extras) { document_["scenes"][0]["extras"] = std::move(extras); }
  void addPosition(GlbVertices& vertices, const Vec3& metres) const;
  /// Returns what addNode() takes. `triangles`: three vertices each, at least one triangle.
  Json addPrimitive(const GlbVertices& vertices, std::span<const Index> triangles, int material);
  /// A node with a mesh of these primitives.
  void addNode(const std::string& name, std::vector<Json> primitives);
  /// Errors: InputError for an empty file, RunError where it cannot be written or passes 4 GiB.
  void write(const std::string& path) const;

 private:
  int addAccessor(const void* data, std::size_t bytes, std::size_t count, const char* type,
                  int component, int target);
  int addVectors(const std::vector<std::array<float, 3>>& values);

  Vec3 origin_;
  Json document_;
  std::vector<char> binary_;
};

}  // namespace radiosity
