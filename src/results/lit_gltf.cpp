// Reads glTF meshes with COLOR_0, or with the _RADIOSITY of this program's lit meshes.
#include "results/lit_mesh.h"
#include "scene/gltf_nodes.h"

namespace radiosity {

namespace {

/// The RGB values of a colour attribute; alpha is ignored.
std::vector<Vec3> readColours(const GltfFile& file, int accessor, const std::string& what) {
  const auto& stored = file.at(file.model.accessors, accessor, "accessor", what);
  const int components = stored.type == TINYGLTF_TYPE_VEC4 ? 4 : 3;
  const std::vector<double> numbers = file.readNumbers(accessor, components, what);
  std::vector<Vec3> colours;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += std::size_t(components)) {
    colours.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  }
  return colours;
}

class LitGltfReader {
 public:
  LitGltfReader(const GltfFile& file, LitMesh& mesh) : file_(file), mesh_(mesh) {}

  void read() {
    mesh_.radiosity = everyPrimitiveHas("_RADIOSITY");
    attribute_ = mesh_.radiosity ? "_RADIOSITY" : "COLOR_0";
    forEachGltfNode(file_, [this](int index, const glm::dmat4& transform, const std::string& what) {
      const tinygltf::Node& node = file_.model.nodes[std::size_t(index)];
      if (node.mesh < 0) return;
      const tinygltf::Mesh& part = file_.at(file_.model.meshes, node.mesh, "mesh", what);
      mesh_.surface_names.push_back(node.name.empty() ? part.name : node.name);
      for (const tinygltf::Primitive& primitive : part.primitives) {
        if (hasTriangles(primitive)) readPrimitive(primitive, transform, what);
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

  void readPrimitive(const tinygltf::Primitive& primitive, const glm::dmat4& transform,
                     const std::string& what) {
    if (!primitive.attributes.contains(attribute_)) {
      file_.fail(what +
                 " has no vertex colours (COLOR_0), so there is no light to compare; bake the "
                 "light into vertex colours and export those; a scene is solved first, and its "
                 "results file compared");
    }
    const int accessor = primitive.attributes.at(attribute_);
    const auto& stored = file_.at(file_.model.accessors, accessor, "accessor", what);
    mesh_.bytes = mesh_.bytes || stored.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    const std::vector<Vec3> positions = readGltfPositions(file_, primitive, transform, what);
    const std::vector<Vec3> colours = readColours(file_, accessor, what + ": " + attribute_);
    if (colours.size() != positions.size()) {
      file_.fail(fmt::format("{} has {} colours for {} vertices; export it again", what,
                             colours.size(), positions.size()));
    }
    const auto first = Index(mesh_.vertices.size());
    mesh_.vertices.insert(mesh_.vertices.end(), positions.begin(), positions.end());
    const std::vector<Index> corners =
        readGltfTriangles(file_, primitive, positions.size(), transform, what);
    for (std::size_t k = 0; k < corners.size(); k += 3) {
      const std::array<Index, 3> at = {corners[k], corners[k + 1], corners[k + 2]};
      appendLitFace(mesh_, std::array{first + at[0], first + at[1], first + at[2]},
                    std::array{colours[at[0]], colours[at[1]], colours[at[2]]},
                    Index(mesh_.surface_names.size() - 1));
    }
  }

  const GltfFile& file_;
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
