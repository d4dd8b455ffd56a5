// Reads glTF meshes with COLOR_0, or with the _RADIOSITY of this program's lit meshes.
#include "results/lit_mesh.h"
#include "scene/gltf/gltf_nodes.h"
#include "scene/gltf/gltf_placement.h"

namespace radiosity {

namespace {

class LitGltfReader {
 public:
  LitGltfReader(const GltfFile& file, LitMesh& mesh) : file_(file), placement_(file), mesh_(mesh) {}

  void read() {
    mesh_.radiosity = everyPrimitiveHas("_RADIOSITY");
    attribute_ = mesh_.radiosity ? "_RADIOSITY" : "COLOR_0";
    forEachGltfNode(file_, [this](int index, const glm::dmat4&, const std::string& what) {
      const tinygltf::Node& node = file_.model.nodes[std::size_t(index)];
      if (node.mesh < 0) return;
      const tinygltf::Mesh& part = file_.at(file_.model.meshes, node.mesh, "mesh", what);
      mesh_.surface_names.push_back(node.name.empty() ? part.name : node.name);
      for (const tinygltf::Primitive& primitive : part.primitives) {
        if (hasTriangles(primitive)) readPrimitive(primitive, index, what);
      }
    });
  }

 private:
  bool everyPrimitiveHas(const std::string& attribute) const {
    for (const tinygltf::Mesh& part : file_.model.meshes) {
      for (const tinygltf::Primitive& primitive : part.primitives) {
        if (hasTriangles(primitive) && !primitive.attributes.contains(attribute)) return false;
      }
    }
    return !file_.model.meshes.empty();
  }

  void readPrimitive(const tinygltf::Primitive& primitive, int node, const std::string& what) {
    if (!primitive.attributes.contains(attribute_)) {
      file_.fail(what +
                 " has no vertex colours (COLOR_0), so there is no light to compare; bake the "
                 "light into vertex colours and export those; a scene is solved first, and its "
                 "results file compared");
    }
    const int accessor = primitive.attributes.at(attribute_);
    const auto& stored = file_.at(file_.model.accessors, accessor, "accessor", what);
    mesh_.bytes = mesh_.bytes || stored.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    const std::vector<Vec3> colours = file_.readColours(accessor, what + ": " + attribute_);
    for (const glm::dmat4& copy : placement_.copies(node, what)) {
      addFaces(placement_.positions(node, primitive, copy, what), colours,
               readGltfTriangles(file_, primitive, colours.size(),
                                 placement_.isMirrored(node, copy), what),
               what);
    }
  }

  void addFaces(const std::vector<Vec3>& positions, const std::vector<Vec3>& colours,
                const std::vector<Index>& corners, const std::string& what) {
    if (colours.size() != positions.size()) {
      file_.fail(fmt::format("{} has {} colours for {} vertices; export it again", what,
                             colours.size(), positions.size()));
    }
    const auto first = Index(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), positions.begin(), positions.end());
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      const std::array<Index, 3> at = {corners[k], corners[k + 1], corners[k + 2]};
      appendLitFace(mesh_, std::array{first + at[0], first + at[1], first + at[2]},
                    std::array{colours[at[0]], colours[at[1]], colours[at[2]]},
                    Index(mesh_.surface_names.size() - 1));
    }
  }

  const GltfFile& file_;
  const GltfPlacement placement_;
  LitMesh& mesh_;
  std::string attribute_;
};

}  // namespace

LitMesh readLitGltf(const std::string& path) {
  const GltfFile file = parseGltf(path);
  LitMesh mesh;
  mesh.file = path;
  LitGltfReader(file, mesh).read();
  return mesh;
}

}  // namespace radiosity
