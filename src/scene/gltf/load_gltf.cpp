#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vector_relational.hpp>
#include <map>
#include <numbers>
#include <numeric>

#include "base/finite.h"
#include "radiosity/spelling.h"
#include "scene/gltf/gltf_materials.h"
#include "scene/gltf/gltf_nodes.h"
#include "scene/gltf/gltf_photometry.h"
#include "scene/gltf/gltf_placement.h"
#include "scene/readers.h"
#include "scene/text.h"

namespace radiosity {

namespace {

using Transform = glm::dmat4;

class Reader {
 public:
  Reader(const GltfFile& file, const SceneOptions& options, Scene& scene)
      : file_(file),
        model_(file.model),
        options_(options),
        placement_(file),
        lamps_(file),
        scene_(scene),
        builder_(scene, options) {}

  void read();

 private:
  void readNode(int index, const Transform& transform, const std::string& what);
  void readMesh(int index);
  void readPrimitive(const tinygltf::Primitive& primitive, int node, const std::string& object,
                     const std::string& what);
  void addFaces(const std::vector<Index>& corners, const std::vector<Index>& vertex_of,
                const std::vector<Vec2>& texcoords, const std::vector<Vec3>& colours,
                Index surface);
  void readCamera(const tinygltf::Node& node, const Transform& transform);
  void readLight(const tinygltf::Node& node, const Transform& transform);
  void readPhotometricLight(const tinygltf::Node& node, const Transform& transform);
  void addChecked(Light light, const std::string& what);
  std::vector<Index> addVertices(const std::vector<Vec3>& positions);
  std::vector<Vec3> readColours(const tinygltf::Primitive& primitive, Index material,
                                const std::string& object, const std::string& what);
  std::vector<Vec2> readTexcoords(const tinygltf::Primitive& primitive, Index material,
                                  std::size_t vertices, const std::string& what) const;
  Index materialOf(const tinygltf::Primitive& primitive, const std::string& object,
                   const std::string& what);
  void requireCount(std::size_t elements, std::size_t vertices, const std::string& what) const;
  void noteUnused();
  bool isNoted(const std::string& extension) const;

  const GltfFile& file_;
  const tinygltf::Model& model_;
  const SceneOptions& options_;
  const GltfPlacement placement_;
  GltfLamps lamps_;
  Scene& scene_;
  SceneBuilder builder_;
  GltfMaterials materials_;
  UniqueNames object_names_;
  UniqueNames light_names_ = lightNames();
  FeatureNotes ignored_;
  std::vector<bool> visited_;
  std::map<Index, std::size_t> faces_of_;  ///< by surface, so far
};

void Reader::read() {
  materials_ = readGltfMaterials(file_, options_, scene_, ignored_);
  if (model_.scenes.size() > 1) {
    ignored_.add("one scene of the file is read",
                 fmt::format("number {}", std::max(model_.defaultScene, 0)), Severity::warning);
  }
  visited_.assign(model_.nodes.size(), false);
  forEachGltfNode(file_, [this](int node, const Transform& transform, const std::string& what) {
    readNode(node, transform, what);
  });
  for (std::string& remark : lamps_.remarks()) {
    scene_.notes.push_back({Severity::warning, std::move(remark)});
  }
  noteUnused();
  if (scene_.faceCount() == 0) {
    file_.fail(fmt::format("no faces: no node of {} has a mesh of triangles; export meshes",
                           model_.scenes.size() > 1
                               ? fmt::format("scene {} of {} (from 0), the one that is shown,",
                                             std::max(model_.defaultScene, 0), model_.scenes.size())
                               : "the scene"));
  }
  builder_.finish();
  ignored_.appendTo(scene_.notes);
}

void Reader::readNode(int index, const Transform& transform, const std::string& what) {
  const tinygltf::Node& node = model_.nodes[std::size_t(index)];
  visited_[std::size_t(index)] = true;
  if (node.mesh >= 0) readMesh(index);
  if (node.camera >= 0) readCamera(node, transform);
  if (node.extensions.contains(kGltfLights)) readLight(node, transform);
  if (node.extensions.contains(kGltfPhotometry)) readPhotometricLight(node, transform);
  for (const auto& [extension, value] : node.extensions) {
    if (isSupportedGltfExtension(extension)) continue;
    ignored_.add(extension + " is not used, node", what.substr(5), Severity::warning);
  }
}

void Reader::readMesh(int index) {
  const tinygltf::Node& node = model_.nodes[std::size_t(index)];
  const tinygltf::Mesh& mesh = file_.at(model_.meshes, node.mesh, "mesh", "node " + node.name);
  std::string wanted = node.name.empty() ? mesh.name : node.name;
  if (wanted.empty()) wanted = fmt::format("mesh{}", node.mesh);
  const std::string object = object_names_.make(wanted);
  if (node.skin >= 0) ignored_.add("skins are in the pose of the file's nodes", object);
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    readPrimitive(mesh.primitives[k], index, object, fmt::format("{}, primitive {}", object, k));
  }
}

void Reader::readPrimitive(const tinygltf::Primitive& primitive, int node,
                           const std::string& object, const std::string& what) {
  if (!hasTriangles(primitive)) {
    ignored_.add("lines and points have no area and are left out, in", object);
    return;
  }
  if (!primitive.attributes.contains("POSITION")) {
    ignored_.add("meshes without positions are left out, in", object, Severity::warning);
    return;
  }
  const Index material = materialOf(primitive, object, what);
  const std::size_t vertices =
      file_.at(model_.accessors, primitive.attributes.at("POSITION"), "accessor", what).count;
  const std::vector<Vec2> texcoords = readTexcoords(primitive, material, vertices, what);
  const std::vector<Vec3> colours = readColours(primitive, material, object, what);
  if (!colours.empty()) requireCount(colours.size(), vertices, what + ": COLOR_0");
  for (const Transform& copy : placement_.copies(node, what)) {
    const std::vector<Index> vertex_of =
        addVertices(placement_.positions(node, primitive, copy, what));
    const std::vector<Index> corners = readGltfTriangles(file_, primitive, vertex_of.size(),
                                                         placement_.isMirrored(node, copy), what);
    addFaces(corners, vertex_of, texcoords, colours, builder_.surface(object, material));
  }
}

/// `corners`: vertices of the primitive, three a triangle; `vertex_of`: their numbers in the scene.
void Reader::addFaces(const std::vector<Index>& corners, const std::vector<Index>& vertex_of,
                      const std::vector<Vec2>& texcoords, const std::vector<Vec3>& colours,
                      Index surface) {
  for (std::size_t k = 0; k < corners.size(); k += 3) {
    std::array<Index, 3> triangle = {corners[k], corners[k + 1], corners[k + 2]};
    std::vector<Vec2> uv;
    std::vector<Vec3> colour;
    for (const Index corner : triangle) {
      if (!texcoords.empty()) uv.push_back(texcoords[corner]);
      if (!colours.empty()) colour.push_back(colours[corner]);
    }
    for (Index& corner : triangle) corner = vertex_of[corner];
    builder_.addFace(triangle, uv, surface, faces_of_[surface]++, colour);
  }
}

/// Vertex colours as a factor of the reflectance (glTF 2.0, 3.9.2); empty if there are none, or if
/// they cannot be one.
std::vector<Vec3> Reader::readColours(const tinygltf::Primitive& primitive, Index material,
                                      const std::string& object, const std::string& what) {
  const auto attribute = primitive.attributes.find("COLOR_0");
  if (attribute == primitive.attributes.end()) return {};
  if (!options_.textures) {
    ignored_.add("textures are off; vertex colours do not count, node", object);
    return {};
  }
  if (material < materials_.unlit.size() && materials_.unlit[material]) {
    ignored_.add(
        "vertex colours of unlit materials are light and do not change the reflectance, "
        "node",
        object, Severity::warning);
    return {};
  }
  std::vector<Vec3> colours = file_.readColours(attribute->second, what + ": COLOR_0");
  const auto isFactor = [](const Vec3& c) {
    return glm::all(glm::greaterThanEqual(c, Vec3(0.0))) &&
           glm::all(glm::lessThanEqual(c, Vec3(1.0)));
  };
  if (std::all_of(colours.begin(), colours.end(), isFactor)) return colours;
  ignored_.add("vertex colours outside 0 to 1 are no reflectance and are not used, node", object,
               Severity::warning);
  return {};
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
    scene_.materials.push_back(defaultMaterial(names.make(kNoMaterial), options_));
  }
  return materials_.none;
}

/// Appends vertices; returns their numbers in the scene.
std::vector<Index> Reader::addVertices(const std::vector<Vec3>& positions) {
  constexpr std::size_t kMostVertices = std::size_t(1) << 28;
  if (scene_.vertices.size() + positions.size() > kMostVertices) {
    file_.fail(fmt::format("has more than {} vertices, each instance with its own; split the scene",
                           kMostVertices));
  }
  std::vector<Index> vertex_of(positions.size());
  std::iota(vertex_of.begin(), vertex_of.end(), Index(scene_.vertices.size()));
  scene_.vertices.insert(scene_.vertices.end(), positions.begin(), positions.end());
  return vertex_of;
}

void Reader::requireCount(std::size_t elements, std::size_t vertices,
                          const std::string& what) const {
  if (elements == vertices) return;
  file_.fail(fmt::format("{} has {} elements for {} vertices; export the scene again", what,
                         elements, vertices));
}

/// Texture coordinates for each vertex, transformed for the material; empty if there are none or if
/// they are not needed.
std::vector<Vec2> Reader::readTexcoords(const tinygltf::Primitive& primitive, Index material,
                                        std::size_t vertices, const std::string& what) const {
  if (!isTextured(scene_.materials[material])) return {};
  const TexcoordSource& source = materials_.texcoords[material];
  const std::string name = fmt::format("TEXCOORD_{}", source.set);
  const auto attribute = primitive.attributes.find(name);
  if (attribute == primitive.attributes.end()) return {};
  const std::vector<double> numbers =
      file_.readNumbers(attribute->second, 2, fmt::format("{}: {}", what, name));
  requireCount(numbers.size() / 2, vertices, fmt::format("{}: {}", what, name));
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
                      camera.vertical_fov > 0 && camera.vertical_fov < std::numbers::pi;
  if (!usable) {
    ignored_.add("cameras without a view direction or an angle are not used", name,
                 Severity::warning);
    return;
  }
  camera.target = camera.eye + glm::normalize(forward);
  camera.up = glm::normalize(camera.up);
  scene_.cameras.push_back(camera);
}

/// KHR_lights_punctual: candela, and lux of a sun, in linear colours; along -z of the node, which
/// its scale does not change.
void Reader::readLight(const tinygltf::Node& node, const Transform& transform) {
  const std::string what = "node " + node.name;
  const tinygltf::Value& number = node.extensions.at(kGltfLights).Get("light");
  if (!number.IsInt()) file_.fail(what + ": its light is no number; export the scene again");
  const tinygltf::Light& gltf = file_.at(model_.lights, number.GetNumberAsInt(), "light", what);
  const std::string named = node.name.empty() ? gltf.name : node.name;
  const Vec3 at(transform[3]);
  const Vec3 forward(transform * glm::dvec4(0, 0, -1, 0));
  Light light{light_names_.make(named.empty() ? gltf.type : named), {}, {1.0, 1.0, 1.0}, true};
  const bool usable = isFinite(at) && isFinite(forward) && glm::length(forward) > 0;
  if (gltf.type == "point") {
    light.kind = PointLight{at, gltf.range};
  } else if (gltf.type == "spot" && usable) {
    const auto degrees = [](double radians) { return radians * 180 / std::numbers::pi; };
    light.kind = SpotLight{at, at + glm::normalize(forward), degrees(gltf.spot.innerConeAngle),
                           degrees(gltf.spot.outerConeAngle), gltf.range};
  } else if (gltf.type == "directional" && usable) {
    Sun sun;
    sun.toward = -glm::normalize(forward);
    sun.diameter = 0;
    light.kind = sun;
  } else {
    ignored_.add("lights without a direction, or of a kind that is none, give no light", light.name,
                 Severity::warning);
    return;
  }
  for (std::size_t b = 0; b < light.strength.size(); ++b) {
    const double colour = gltf.color.size() == light.strength.size() ? gltf.color[b] : 1;
    light.strength[b] = gltf.intensity * colour / kLumensPerWatt;
  }
  ignored_.add(fmt::format("lamps in candela and lux, taken at {} lm/W", kLumensPerWatt),
               light.name);
  addChecked(std::move(light), what);
}

void Reader::readPhotometricLight(const tinygltf::Node& node, const Transform& transform) {
  const std::string what = "node " + node.name;
  Light light = lamps_.read(node, transform, what);
  light.name = light_names_.make(node.name.empty() ? light.fileName() : node.name);
  addChecked(std::move(light), what);
}

void Reader::addChecked(Light light, const std::string& what) {
  try {
    light.validate();
  } catch (const InputError& error) {
    file_.fail(fmt::format("{}: {}; correct the light", what, error.what()));
  }
  setLight(scene_.lights, std::move(light));
}

void Reader::noteUnused() {
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
    if (isSupportedGltfExtension(extension) || isNoted(extension)) continue;
    if (extension == "EXT_lights_image_based") {
      // The six sides of a cube in several blurs, and the irradiance of these.
      ignored_.add(fmt::format("light of cubes of images is left out ({} takes a plain image)",
                               spelled("image_sky", "SKY.hdr")),
                   extension, Severity::warning);
      continue;
    }
    const auto& required = model_.extensionsRequired;
    if (std::find(required.begin(), required.end(), extension) != required.end()) {
      ignored_.add("required extensions that are not read; materials may look different", extension,
                   Severity::warning);
    } else {
      ignored_.add("optional extensions that are not read", extension);
    }
  }
}

/// Whether the note on an extension names the materials or nodes that have it.
bool Reader::isNoted(const std::string& extension) const {
  for (std::size_t k = 0; k < visited_.size(); ++k) {
    if (visited_[k] && model_.nodes[k].extensions.contains(extension)) return true;
  }
  return std::any_of(model_.materials.begin(), model_.materials.end(),
                     [&](const tinygltf::Material& m) { return m.extensions.contains(extension); });
}

}  // namespace

Scene loadGltf(const std::string& path, const SceneOptions& options) {
  const GltfFile file = parseGltf(path);
  Scene scene;
  scene.file = path;
  if (options.kd_is_srgb) {
    scene.notes.push_back(
        {Severity::warning, "sRGB base colours are an option for OBJ; glTF's are linear"});
  }
  if (options.vertex_colours == VertexColours::srgb) {
    scene.notes.push_back(
        {Severity::warning,
         "sRGB vertex colours are an option for other formats; glTF's are linear"});
  }
  Reader(file, options, scene).read();
  return scene;
}

}  // namespace radiosity
