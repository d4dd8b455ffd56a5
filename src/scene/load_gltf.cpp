#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "scene/gltf_materials.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

using Transform = glm::dmat4;

bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

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

class Reader {
 public:
  Reader(const GltfFile& file, const SceneOptions& options, Scene& scene)
      : file_(file), model_(file.model), options_(options), scene_(scene), builder_(scene) {}

  void read();

 private:
  void readNode(int index, const Transform& parent);
  void readMesh(const tinygltf::Node& node, const Transform& transform);
  void readPrimitive(const tinygltf::Primitive& primitive, const std::string& object,
                     const std::string& what, const Transform& transform);
  void readCamera(const tinygltf::Node& node, const Transform& transform);
  std::vector<int> rootNodes();
  Transform localTransform(const tinygltf::Node& node, const std::string& what) const;
  std::vector<Index> readPositions(const tinygltf::Primitive& primitive, const std::string& what,
                                   const Transform& transform);
  std::vector<Vec2> readTexcoords(const tinygltf::Primitive& primitive, Index material,
                                  std::size_t vertices, const std::string& what) const;
  Index materialOf(const tinygltf::Primitive& primitive, const std::string& object,
                   const std::string& what);
  void noteUnused();

  const GltfFile& file_;
  const tinygltf::Model& model_;
  const SceneOptions& options_;
  Scene& scene_;
  SceneBuilder builder_;
  GltfMaterials materials_;
  UniqueNames object_names_;
  FeatureNotes ignored_;
  std::vector<bool> visited_;
  std::map<Index, std::size_t> faces_of_;  ///< by surface, so far
};

void Reader::read() {
  materials_ = readGltfMaterials(file_, options_, scene_, ignored_);
  visited_.assign(model_.nodes.size(), false);
  for (const int node : rootNodes()) readNode(node, Transform(1.0));
  noteUnused();
  if (scene_.faceCount() == 0) {
    file_.fail("no faces: no node of the scene has a mesh of triangles; export meshes");
  }
  builder_.finish();
  ignored_.appendTo(scene_.notes);
}

std::vector<int> Reader::rootNodes() {
  if (!model_.scenes.empty()) {
    const int index = std::max(model_.defaultScene, 0);
    if (model_.scenes.size() > 1) {
      ignored_.add("one scene of the file is read", fmt::format("number {}", index),
                   Severity::warning);
    }
    return file_.at(model_.scenes, index, "scene", "the file").nodes;
  }
  // Without scenes every node that is no child is a root.
  std::vector<bool> is_child(model_.nodes.size(), false);
  for (const tinygltf::Node& node : model_.nodes) {
    for (const int child : node.children) {
      file_.at(model_.nodes, child, "node", "node " + node.name);
      is_child[std::size_t(child)] = true;
    }
  }
  std::vector<int> roots;
  for (std::size_t k = 0; k < is_child.size(); ++k) {
    if (!is_child[k]) roots.push_back(int(k));
  }
  return roots;
}

void Reader::readNode(int index, const Transform& parent) {
  // An explicit stack: a chain of nodes may be longer than the call stack is deep.
  std::vector<std::pair<int, Transform>> waiting = {{index, parent}};
  while (!waiting.empty()) {
    const auto [current, outer] = waiting.back();
    waiting.pop_back();
    const tinygltf::Node& node = file_.at(model_.nodes, current, "node", "the node tree");
    const std::string what =
        fmt::format("node {}", node.name.empty() ? std::to_string(current) : node.name);
    if (visited_[std::size_t(current)]) {
      file_.fail(what + " is reached twice, nodes must form a tree; export the scene again");
    }
    visited_[std::size_t(current)] = true;
    const Transform transform = outer * localTransform(node, what);
    if (node.mesh >= 0) readMesh(node, transform);
    if (node.camera >= 0) readCamera(node, transform);
    for (const auto& [extension, value] : node.extensions) {
      ignored_.add(extension + " is not used, node", what.substr(5), Severity::warning);
    }
    // The last one in is the first one out: children are read in their order.
    for (std::size_t k = node.children.size(); k-- > 0;) {
      waiting.emplace_back(node.children[k], transform);
    }
  }
}

Transform Reader::localTransform(const tinygltf::Node& node, const std::string& what) const {
  const auto sized = [&](const std::vector<double>& values, std::size_t size, const char* name) {
    if (values.empty()) return false;
    if (values.size() != size) {
      file_.fail(fmt::format("{}: {} is not {} numbers; correct it", what, name, size));
    }
    return true;
  };
  Transform transform(1.0);
  if (sized(node.matrix, 16, "matrix")) {
    // Column-major on both sides.
    for (int k = 0; k < 16; ++k) transform[k / 4][k % 4] = node.matrix[std::size_t(k)];
    return transform;
  }
  if (sized(node.rotation, 4, "rotation")) {
    const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(turn);
    if (!(length > 0)) file_.fail(what + ": rotation is the zero quaternion; correct it");
    // Written with 7 digits as a rule: made unit again so that lengths are kept in double.
    transform = glm::mat4_cast(turn / length);
  }
  if (sized(node.scale, 3, "scale")) {
    for (int k = 0; k < 3; ++k) transform[k] *= node.scale[std::size_t(k)];
  }
  if (sized(node.translation, 3, "translation")) {
    transform[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
  }
  return transform;
}

void Reader::readMesh(const tinygltf::Node& node, const Transform& transform) {
  const tinygltf::Mesh& mesh = file_.at(model_.meshes, node.mesh, "mesh", "node " + node.name);
  std::string wanted = node.name.empty() ? mesh.name : node.name;
  if (wanted.empty()) wanted = fmt::format("mesh{}", node.mesh);
  const std::string object = object_names_.make(wanted);
  if (node.skin >= 0) ignored_.add("skins are not applied, node", object, Severity::warning);
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    readPrimitive(mesh.primitives[k], object, fmt::format("{}, primitive {}", object, k),
                  transform);
  }
}

void Reader::readPrimitive(const tinygltf::Primitive& primitive, const std::string& object,
                           const std::string& what, const Transform& transform) {
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    ignored_.add("lines and points have no area and are left out, in", object);
    return;
  }
  if (!primitive.attributes.contains("POSITION")) {
    ignored_.add("meshes without positions are left out, in", object, Severity::warning);
    return;
  }
  if (!primitive.targets.empty()) ignored_.add("morph targets are not applied, node", object);
  if (primitive.attributes.contains("COLOR_0")) {
    ignored_.add("vertex colours do not change the reflectance, node", object, Severity::warning);
  }
  const Index material = materialOf(primitive, object, what);
  const std::vector<Index> vertex_of = readPositions(primitive, what, transform);
  const std::vector<Vec2> texcoords = readTexcoords(primitive, material, vertex_of.size(), what);
  std::vector<Index> indices;
  if (primitive.indices >= 0) {
    indices = file_.readIndices(primitive.indices, what + ": indices");
  } else {
    for (std::size_t k = 0; k < vertex_of.size(); ++k) indices.push_back(Index(k));
  }
  for (const Index index : indices) {
    if (index < vertex_of.size()) continue;
    file_.fail(fmt::format("{}: vertex {} does not exist, there are {}; export the scene again",
                           what, index, vertex_of.size()));
  }
  const std::vector<Index> corners = triangleCorners(indices, mode);
  if (corners.size() % 3 != 0 || corners.empty()) {
    file_.fail(fmt::format("{}: {} indices do not make triangles; export the scene again", what,
                           indices.size()));
  }
  // Mirrored nodes keep their fronts: glTF winds them the other way (3.7.4).
  const bool mirrored = glm::determinant(glm::dmat3(transform)) < 0;
  const Index surface = builder_.surface(object, material);
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    std::array<Index, 3> triangle = {corners[k], corners[k + 1], corners[k + 2]};
    if (mirrored) std::swap(triangle[1], triangle[2]);
    std::vector<Vec2> uv;
    if (!texcoords.empty()) {
      uv = {texcoords[triangle[0]], texcoords[triangle[1]], texcoords[triangle[2]]};
    }
    for (Index& corner : triangle) corner = vertex_of[corner];
    builder_.addFace(triangle, uv, surface, faces_of_[surface]++);
  }
}

Index Reader::materialOf(const tinygltf::Primitive& primitive, const std::string& object,
                         const std::string& what) {
  if (primitive.material >= 0) {
    file_.at(model_.materials, primitive.material, "material", what);
    return Index(primitive.material);
  }
  ignored_.add(fmt::format("no material, reflectance {}", options_.default_reflectance), object,
               Severity::warning);
  if (materials_.none == kNone) {
    UniqueNames names;
    for (const Material& material : scene_.materials) names.make(material.name);
    materials_.none = Index(scene_.materials.size());
    materials_.texcoords.emplace_back();
    scene_.materials.push_back(defaultMaterial(names.make("default"), options_));
  }
  return materials_.none;
}

/// Appends the vertices; returns the scene's number of each.
std::vector<Index> Reader::readPositions(const tinygltf::Primitive& primitive,
                                         const std::string& what, const Transform& transform) {
  const std::vector<double> numbers =
      file_.readNumbers(primitive.attributes.at("POSITION"), 3, what + ": POSITION");
  std::vector<Index> vertex_of;
  for (std::size_t k = 0; k < numbers.size(); k += 3) {
    const Vec3 position(transform * glm::dvec4(numbers[k], numbers[k + 1], numbers[k + 2], 1.0));
    if (!isFinite(position)) {
      file_.fail(fmt::format("{}: vertex {} is not finite; correct the mesh or its transform", what,
                             k / 3));
    }
    vertex_of.push_back(Index(scene_.vertices.size()));
    scene_.vertices.push_back(position);
  }
  return vertex_of;
}

/// One per vertex, transformed as the material asks; empty where there are none or none is needed.
std::vector<Vec2> Reader::readTexcoords(const tinygltf::Primitive& primitive, Index material,
                                        std::size_t vertices, const std::string& what) const {
  if (scene_.materials[material].texture == kNone) return {};
  const TexcoordSource& source = materials_.texcoords[material];
  const std::string name = fmt::format("TEXCOORD_{}", source.set);
  const auto attribute = primitive.attributes.find(name);
  if (attribute == primitive.attributes.end()) return {};
  const std::vector<double> numbers =
      file_.readNumbers(attribute->second, 2, fmt::format("{}: {}", what, name));
  if (numbers.size() != 2 * vertices) {
    file_.fail(fmt::format("{}: {} has {} elements for {} vertices; export the scene again", what,
                           name, numbers.size() / 2, vertices));
  }
  std::vector<Vec2> result;
  for (std::size_t k = 0; k < numbers.size(); k += 2) {
    result.push_back(source.apply({numbers[k], numbers[k + 1]}));
    if (!std::isfinite(result.back().x) || !std::isfinite(result.back().y)) {
      file_.fail(
          fmt::format("{}: {} of vertex {} is not finite; correct the mesh", what, name, k / 2));
    }
  }
  return result;
}

void Reader::readCamera(const tinygltf::Node& node, const Transform& transform) {
  const tinygltf::Camera& gltf =
      file_.at(model_.cameras, node.camera, "camera", "node " + node.name);
  std::string name = node.name.empty() ? gltf.name : node.name;
  if (name.empty()) name = fmt::format("camera{}", scene_.cameras.size() + 1);
  if (gltf.type != "perspective") {
    ignored_.add("orthographic cameras are not used", name, Severity::warning);
    return;
  }
  // A glTF camera looks along its own -z, +y up.
  const Vec3 forward(transform * glm::dvec4(0, 0, -1, 0));
  Camera camera;
  camera.name = name;
  camera.eye = Vec3(transform[3]);
  camera.up = Vec3(transform * glm::dvec4(0, 1, 0, 0));
  camera.vertical_fov = gltf.perspective.yfov;
  camera.aspect = gltf.perspective.aspectRatio;
  const bool usable = isFinite(camera.eye) && glm::length(glm::cross(forward, camera.up)) > 0 &&
                      camera.vertical_fov > 0 && camera.vertical_fov < glm::pi<double>();
  if (!usable) {
    ignored_.add("cameras without a view direction or an angle are not used", name,
                 Severity::warning);
    return;
  }
  camera.target = camera.eye + glm::normalize(forward);
  camera.up = glm::normalize(camera.up);
  scene_.cameras.push_back(camera);
}

void Reader::noteUnused() {
  for (const tinygltf::Light& light : model_.lights) {
    ignored_.add("punctual lights give no light here, make them surfaces that emit",
                 light.name.empty() ? light.type : light.name, Severity::warning);
  }
  for (std::size_t k = 0; k < visited_.size(); ++k) {
    if (visited_[k] || model_.nodes[k].mesh < 0) continue;
    const std::string& name = model_.nodes[k].name;
    ignored_.add("not part of the scene that is read, node",
                 name.empty() ? std::to_string(k) : name, Severity::warning);
  }
  if (!model_.animations.empty()) {
    ignored_.add("animations are not played", fmt::format("{}", model_.animations.size()));
  }
  for (const std::string& extension : model_.extensionsUsed) {
    if (!isSupportedGltfExtension(extension)) {
      ignored_.add("optional extensions that are not read", extension);
    }
  }
}

}  // namespace

Scene loadGltf(const std::string& path, bool binary, const SceneOptions& options) {
  const GltfFile file = parseGltf(path, binary);
  Scene scene;
  scene.file = path;
  if (options.kd_is_srgb) {
    scene.notes.push_back(
        {Severity::warning, "sRGB base colours are an option for OBJ; glTF's are linear"});
  }
  Reader(file, options, scene).read();
  return scene;
}

}  // namespace radiosity
