// The glTF file that a scene was read from, with the coordinates of a lightmap added.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "radiosity/lightmap.h"
#include "scene/gltf/gltf_file.h"

namespace radiosity {

class GltfPlacement;

/// Edits the file's own JSON, so that everything else in it stays. Meshes get coordinates, one mesh
/// for each node; copies of a node (kGltfInstancing) become nodes below it. Vertices on the border
/// of charts are split. A primitive whose backs have charts becomes two, one for each side.
class LightmapGltf {
 public:
  using Json = nlohmann::ordered_json;

  /// `map`: of the scene that was read from `source`. Errors: as parseGltf(), and InputError if the
  /// file no longer has that scene.
  LightmapGltf(const std::string& source, const Scene& scene, const Lightmap& map);

  /// The n of TEXCOORD_n: the first that no primitive of the file has, at least 1.
  int set() const { return set_; }
  void setExtras(const Json& extras);
  /// Errors: as writeGlb().
  void write(const std::string& path) const;

 private:
  /// The triangles of one side of a primitive; its vertices are copies of the file's.
  struct Part {
    std::vector<Index> copy_of;
    std::vector<std::array<float, 2>> texcoord;
    std::vector<Index> corners;
    std::map<std::pair<Index, Index>, Index> known;  ///< by vertex of the file and chart
  };
  /// A primitive with its place in the scene: its triangles are faces from `first_face` on.
  struct Placed {
    const tinygltf::Primitive& primitive;
    std::size_t vertices = 0;
    std::vector<Index> corners;  ///< three a face, in the scene's order
    bool mirrored = false;       ///< the file has them in reverse order
    std::size_t first_face = 0;
    std::string what;
  };

  void joinBuffers();
  void embedImages();
  void chooseSet();
  void addMeshes();
  std::vector<Json> meshesOf(int number, const Json& given, const GltfPlacement& placement,
                             const std::string& what, std::size_t& face);
  Json primitivesOf(const tinygltf::Primitive& primitive, const Json& given,
                    const GltfPlacement& placement, int number, const glm::dmat4& copy,
                    const std::string& what, std::size_t& face);
  bool isInScene(const Placed& placed, std::span<const Vec3> positions) const;
  [[noreturn]] void failForOtherScene() const;
  void addCopies(int number, std::span<const std::size_t> meshes,
                 std::span<const glm::dmat4> places);
  void forgetInstancing();
  Json addPrimitives(const Json& given, const Placed& placed);
  void addCorner(Part& part, Index vertex, const LightmapTriangle* triangle, std::size_t k) const;
  Part partOf(const Placed& placed, int side) const;
  static bool isOneToOne(const Part& part, std::size_t vertices);
  Json keptPrimitive(Json primitive, const Placed& placed, const Part& part);
  Json newPrimitive(Json primitive, const Placed& placed, const Part& part, bool turned);
  void copyAttributes(Json& attributes, const std::map<std::string, int>& given,
                      const Placed& placed, const Part& part, bool turned);
  void nameSets(Json& attributes, int texcoords) const;
  int oneSided(int material);
  int addView(const std::vector<char>& bytes, int target, std::size_t stride);
  int addAccessor(std::span<const double> values, const tinygltf::Accessor& like, bool with_bounds);
  int addTexcoords(std::span<const std::array<float, 2>> values);
  int addIndices(std::span<const Index> values);

  GltfFile file_;
  const Scene& scene_;
  const Lightmap& map_;
  std::array<std::vector<Index>, 2> of_face_;  ///< by side: into map_.triangles, or kNone
  Json document_;
  std::vector<char> binary_;
  int set_ = 1;
  std::map<int, int> one_sided_;  ///< copies of materials
};

}  // namespace radiosity
