// glTF 2.0 binary files, written by hand: a JSON chunk and a chunk of float and index arrays.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The origin of the file's coordinates: 0, or the middle of the vertices if it is farther from 0
/// than they are apart. Positions are 32-bit floats relative to it; it becomes the translation of
/// nodes, which has 64-bit numbers.
Vec3 floatOrigin(std::span<const Vec3> vertices);

/// Writes a glTF document and its buffer, which becomes the document's only one, as a binary file.
/// Errors: RunError if it cannot be written or is larger than 4 GiB.
void writeGlb(const std::string& path, nlohmann::ordered_json document,
              std::span<const char> binary);

// Numbers of the specification (glTF 2.0, 3.6.2).
inline constexpr int kGltfFloat = 5126;
inline constexpr int kGltfUnsignedInt = 5125;
inline constexpr int kGltfArrayBuffer = 34962;
inline constexpr int kGltfElementArrayBuffer = 34963;

/// Attributes of the vertices of one primitive; all but the position may be empty.
struct GlbVertices {
  std::vector<std::array<float, 3>> position;
  std::vector<std::array<float, 3>> colour;     ///< COLOR_0, linear
  std::vector<std::array<float, 3>> radiosity;  ///< _RADIOSITY, W/m^2
  std::vector<std::array<float, 2>> lightmap;   ///< TEXCOORD_1, and 0, since sets begin at 0
  std::size_t count() const { return position.size(); }
};

class GlbWriter {
 public:
  using Json = nlohmann::ordered_json;

  explicit GlbWriter(const Vec3& origin);
  int addMaterial(Json material);
  void useExtension(const std::string& name) { document_["extensionsUsed"].push_back(name); }
  /// Sets facts about the whole file on the scene, where Blender shows them.
  void setExtras(Json extras) { document_["scenes"][0]["extras"] = std::move(extras); }
  void addPosition(GlbVertices& vertices, const Vec3& metres) const;
  /// Returns a primitive for addNode(). `triangles`: three vertices each, at least one triangle.
  Json addPrimitive(const GlbVertices& vertices, std::span<const Index> triangles, int material);
  /// Adds a node with a mesh of these primitives.
  void addNode(const std::string& name, std::vector<Json> primitives);
  /// Errors: InputError for an empty file, and those of writeGlb().
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
