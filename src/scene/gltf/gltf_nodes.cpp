#include "scene/gltf/gltf_nodes.h"

#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace radiosity {

namespace {

using Transform = glm::dmat4;

/// Corner numbers of the triangles of a primitive, three each (glTF 2.0, 3.7.2.1). An odd triangle
/// of a strip is wound the other way, so its first two corners change places.
std::vector<Index> triangleCorners(const std::vector<Index>& indices, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return indices;
  std::vector<Index> corners;
  for (std::size_t k = 0; k + 2 < indices.size(); ++k) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      corners.insert(corners.end(), {indices[k + 1], indices[k + 2], indices[0]});
    } else {
      const std::size_t odd = k % 2;
      corners.insert(corners.end(), {indices[k], indices[k + 1 + odd], indices[k + 2 - odd]});
    }
  }
  return corners;
}

int modeOf(const tinygltf::Primitive& primitive) {
  return primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
}

std::vector<int> rootNodes(const GltfFile& file) {
  const tinygltf::Model& model = file.model;
  if (!model.scenes.empty()) {
    return file.at(model.scenes, std::max(model.defaultScene, 0), "scene", "the file").nodes;
  }
  // Without scenes every node that is not a child is a root.
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      file.at(model.nodes, child, "node", "node " + node.name);
      is_child[std::size_t(child)] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t k = 0; k < is_child.size(); ++k) {
    if (!is_child[k]) roots.push_back(int(k));
  }
  return roots;
}

Transform localTransform(const GltfFile& file, const tinygltf::Node& node,
                         const std::string& what) {
  const auto sized = [&](const std::vector<double>& values, std::size_t size, const char* name) {
    if (values.empty()) return false;
    if (values.size() != size) {
      file.fail(fmt::format("{}: {} is not {} numbers; correct it", what, name, size));
    }
    return true;
  };
  Transform transform(1.0);
  if (sized(node.matrix, 16, "matrix")) {
    // Column-major on both sides.
    for (int k = 0; k < 16; ++k) transform[k / 4][k % 4] = node.matrix[std::size_t(k)];
    return transform;
  }
  const bool turned = sized(node.rotation, 4, "rotation");
  const bool scaled = sized(node.scale, 3, "scale");
  const bool moved = sized(node.translation, 3, "translation");
  return gltfTransform(file, moved ? node.translation.data() : nullptr,
                       turned ? node.rotation.data() : nullptr,
                       scaled ? node.scale.data() : nullptr, what);
}

}  // namespace

glm::dmat4 gltfTransform(const GltfFile& file, const double* translation, const double* rotation,
                         const double* scale, const std::string& what) {
  Transform transform(1.0);
  if (rotation != nullptr) {
    const glm::dquat turn(rotation[3], rotation[0], rotation[1], rotation[2]);
    const double length = glm::length(turn);
    if (!(length > 0)) file.fail(what + ": rotation is the zero quaternion; correct it");
    // Files usually have 7 digits; we normalise the rotation again so that it keeps lengths.
    transform = glm::mat4_cast(turn / length);
  }
  for (int k = 0; k < 3; ++k) {
    if (scale != nullptr) transform[k] *= scale[k];
    if (translation != nullptr) transform[3][k] = translation[k];
  }
  return transform;
}

void forEachGltfNode(const GltfFile& file,
                     const std::function<void(int, const glm::dmat4&, const std::string&)>& visit) {
  const tinygltf::Model& model = file.model;
  std::vector<bool> visited(model.nodes.size(), false);
  for (const int root : rootNodes(file)) {
    // We use an explicit stack, since a chain of nodes may be longer than the call stack allows.
    std::vector<std::pair<int, Transform>> waiting = {{root, Transform(1.0)}};
    while (!waiting.empty()) {
      const auto [current, outer] = waiting.back();
      waiting.pop_back();
      const tinygltf::Node& node = file.at(model.nodes, current, "node", "the node tree");
      const std::string what =
          fmt::format("node {}", node.name.empty() ? std::to_string(current) : node.name);
      if (visited[std::size_t(current)]) {
        file.fail(what + " is reached twice, nodes must form a tree; export the scene again");
      }
      visited[std::size_t(current)] = true;
      const Transform transform = outer * localTransform(file, node, what);
      visit(current, transform, what);
      // We push children in reverse, so that they are read in their order.
      for (std::size_t k = node.children.size(); k-- > 0;) {
        waiting.emplace_back(node.children[k], transform);
      }
    }
  }
}

bool hasTriangles(const tinygltf::Primitive& primitive) {
  const int mode = modeOf(primitive);
  return mode >= TINYGLTF_MODE_TRIANGLES && mode <= TINYGLTF_MODE_TRIANGLE_FAN;
}

std::vector<Index> readGltfTriangles(const GltfFile& file, const tinygltf::Primitive& primitive,
                                     std::size_t vertices, bool mirrored, const std::string& what) {
  std::vector<Index> indices;
  if (primitive.indices >= 0) {
    indices = file.readIndices(primitive.indices, what + ": indices");
  } else {
    for (std::size_t k = 0; k < vertices; ++k) indices.push_back(Index(k));
  }
  for (const Index index : indices) {
    if (index < vertices) continue;
    file.fail(fmt::format("{}: vertex {} does not exist, there are {}; export the scene again",
                          what, index, vertices));
  }
  std::vector<Index> corners = triangleCorners(indices, modeOf(primitive));
  if (corners.size() % 3 != 0 || corners.empty()) {
    file.fail(fmt::format("{}: {} indices do not make triangles; export the scene again", what,
                          indices.size()));
  }
  if (mirrored) {
    for (std::size_t k = 0; k < corners.size(); k += 3) std::swap(corners[k + 1], corners[k + 2]);
  }
  return corners;
}

}  // namespace radiosity
