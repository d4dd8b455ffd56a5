// Reads Collada, FBX, 3DS, IFC and DXF by Assimp. Nodes are objects.
#include <assimp/types.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string_view>

#include "base/file_name.h"
#include "base/finite.h"
#include "base/input_file.h"
#include "radiosity/spelling.h"
#include "scene/assimp/assimp_lights.h"
#include "scene/assimp/assimp_materials.h"
#include "scene/assimp/assimp_process.h"
#include "scene/assimp/assimp_scene.h"
#include "scene/assimp/assimp_vectors.h"
#include "scene/assimp/collada_cameras.h"
#include "scene/assimp/nesting_preflight.h"
#include "scene/assimp/xml_preflight.h"
#include "scene/mesh_cursor.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

class AssimpReader {
 public:
  AssimpReader(const std::string& path, const SceneOptions& options)
      : options_(options), builder_(scene_, options) {
    scene_.file = path;
  }

  Scene read() {
    const std::string extension = lowerExtension(scene_.file);
    if (extension == ".dae") collada_.emplace(checkXml(scene_.file), notes_);
    const auto [file, why] = readByAssimp(scene_.file);
    if (!why.empty()) {
      if (why.find("mNumMeshes is 0") != std::string::npos) failWithoutFaces();
      fail(fmt::format("cannot be read ({}); export it again, or as .obj or .glb", onOneLine(why)));
    }
    materials_ = readAssimpMaterials(file, options_, scene_, notes_);
    scale_ = file.centimetres.value_or(100) / 100;
    AssimpLights lights(file.lights, extension, scale_, notes_);
    addNodes(file, lights);
    if (scene_.faceCount() == 0) failWithoutFaces();
    lights.addTo(scene_);
    notes_.appendTo(scene_.notes);
    builder_.finish();
    // In all of these formats a texture replaces the colour.
    for (Material& material : scene_.materials) {
      if (material.texture != kNone) material.reflectance = Vec3(1.0);
    }
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", scene_.file, what));
  }

  [[noreturn]] void failWithoutFaces() const {
    fail("no faces; export the scene with its meshes as polygons");
  }

  std::string objectName(const AssimpScene& file, const AssimpNode& node,
                         const AssimpMesh& mesh) const;
  void addNodes(const AssimpScene& file, AssimpLights& lights);
  std::vector<Vec3> coloursOf(const AssimpMesh& mesh, const std::string& object);
  void addMesh(const AssimpMesh& mesh, const std::string& object, const aiMatrix4x4& place);
  Index colouredByVertices(Index material);
  void addCameras(const AssimpNode& node, const aiMatrix4x4& place);
  void addCamera(Camera camera, const Vec3& forward);

  const SceneOptions& options_;
  Scene scene_;
  SceneBuilder builder_;
  std::vector<AssimpMaterial> materials_;  ///< by number in the file
  FeatureNotes notes_;
  double scale_ = 1;
  std::multimap<std::string, const AssimpCamera*> camera_of_;  ///< by its node
  std::optional<ColladaCameras> collada_;                      ///< replaces camera_of_
  std::map<Index, Index> coloured_;  ///< by material: the same for colours of vertices
};

/// Whether Assimp invented the name.
bool isMadeUp(std::string_view name) {
  return name.empty() || name[0] == '<' || name.starts_with("$ColladaAutoName$");
}

/// The name of an object. If an IFC file has an object in several places, such as a window, Assimp
/// names it after the kind of reference; then the node above has the name.
std::string AssimpReader::objectName(const AssimpScene& file, const AssimpNode& node,
                                     const AssimpMesh& mesh) const {
  std::string of_file = std::filesystem::path(scene_.file).stem().string();
  constexpr std::string_view kReference = "IfcMappedItem";
  const AssimpNode* named = &node;
  while (named != &file.nodes.front() && named->name == kReference) {
    named = &file.nodes[named->parent];
  }
  for (const std::string& name : {named->name, named->collada_id, mesh.name}) {
    if (!isMadeUp(name)) return name;
  }
  return of_file;
}

aiMatrix4x4 matrixOf(const std::array<float, 16>& m) {
  return {m[0], m[1], m[2],  m[3],  m[4],  m[5],  m[6],  m[7],
          m[8], m[9], m[10], m[11], m[12], m[13], m[14], m[15]};
}

void AssimpReader::addNodes(const AssimpScene& file, AssimpLights& lights) {
  for (const AssimpCamera& camera : file.cameras) camera_of_.emplace(camera.node, &camera);
  std::vector<aiMatrix4x4> places;
  for (const AssimpNode& node : file.nodes) {
    const aiMatrix4x4 above = places.empty() ? aiMatrix4x4() : places[node.parent];
    const aiMatrix4x4& place = places.emplace_back(above * matrixOf(node.place));
    for (const std::uint32_t m : node.meshes) {
      const AssimpMesh& mesh = file.meshes[m];
      addMesh(mesh, objectName(file, node, mesh), place);
    }
    addCameras(node, place);
    lights.addNode(node.name, place);
  }
}

/// The material without a colour, for vertices whose colours are the reflectance.
Index AssimpReader::colouredByVertices(Index material) {
  const auto [place, is_new] = coloured_.emplace(material, Index(scene_.materials.size()));
  if (is_new) {
    Material copy = scene_.materials[material];
    copy.name += " (vertex colours)";
    copy.reflectance = Vec3(1.0);
    scene_.materials.push_back(std::move(copy));
  }
  return place->second;
}

/// Factors of the reflectance, one a vertex; empty if there are none, or if they are not used.
std::vector<Vec3> AssimpReader::coloursOf(const AssimpMesh& mesh, const std::string& object) {
  if (mesh.colours.empty()) return {};
  if (options_.vertex_colours == VertexColours::unused) {
    notes_.add(fmt::format(
                   "colours of vertices do not change the reflectance ({} or linear uses them), in",
                   spelled("vertex_colours", "srgb")),
               object, Severity::warning);
    return {};
  }
  std::vector<Vec3> factors;
  for (std::size_t v = 0; v < mesh.colours.size(); ++v) {
    const auto& given = mesh.colours[v];
    const Vec3 colour{double(given[0]), double(given[1]), double(given[2])};
    const std::optional<Vec3> factor = factorOfColour(colour, options_.vertex_colours);
    if (!factor) {
      fail(
          fmt::format("object {}: a colour of vertex {} is outside 0 to 1; scale it, or leave out "
                      "{}",
                      object, v, spelled("vertex_colours")));
    }
    factors.push_back(*factor);
  }
  return factors;
}

void AssimpReader::addMesh(const AssimpMesh& mesh, const std::string& object,
                           const aiMatrix4x4& place) {
  if (mesh.vertices.empty()) return notes_.add("shapes without corners are left out", object);
  const std::size_t first = scene_.vertices.size();
  if (first + mesh.vertices.size() >= kNone) fail("too many vertices; split the scene");
  for (const std::array<float, 3>& vertex : mesh.vertices) {
    const aiVector3D p = place * vectorOf(vertex);
    scene_.vertices.push_back(scale_ * doublesOf(p));
    if (!isFinite(scene_.vertices.back())) {
      fail(fmt::format("object {}: a coordinate is not a finite number; export it again", object));
    }
  }
  const std::vector<Vec3> colours = coloursOf(mesh, object);
  const bool mirrors = place.Determinant() < 0;
  Index material = materials_[mesh.material].index;
  if (!colours.empty() && !materials_[mesh.material].has_colour) {
    material = colouredByVertices(material);
  }
  const Index surface = builder_.surface(object, material);
  std::vector<Index> corners;
  std::vector<Vec2> pairs;
  std::vector<Vec3> factors;
  const std::uint32_t* indices = mesh.indices.data();
  for (std::size_t f = 0; f < mesh.corners.size(); indices += mesh.corners[f++]) {
    const std::uint32_t count = mesh.corners[f];
    if (count < 3) {
      notes_.add("lines and points have no area and are left out, in", object);
      continue;
    }
    corners.clear();
    pairs.clear();
    factors.clear();
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t vertex = indices[mirrors ? count - 1 - k : k];
      corners.push_back(Index(first + vertex));
      if (!colours.empty()) factors.push_back(colours[vertex]);
      if (mesh.texcoords.empty()) continue;
      // Assimp's origin is the bottom left corner.
      const auto& [right, up] = mesh.texcoords[vertex];
      pairs.emplace_back(double(right), 1 - double(up));
      if (!std::isfinite(pairs.back().x) || !std::isfinite(pairs.back().y)) {
        fail(fmt::format("object {}: a texture coordinate is not a finite number; export it again",
                         object));
      }
    }
    builder_.addFace(corners, pairs, surface, Index(f), factors);
  }
}

/// Adds the cameras of a node. Assimp's angle is the full horizontal one for all formats.
void AssimpReader::addCameras(const AssimpNode& node, const aiMatrix4x4& place) {
  const aiMatrix3x3 turn(place);
  const auto add = [&](Camera camera, const AssimpCamera& pose) {
    const std::string& id = node.collada_id;
    camera.name = isMadeUp(node.name) && !id.empty() ? id : node.name;
    camera.eye = scale_ * doublesOf(place * vectorOf(pose.eye));
    camera.up = doublesOf(turn * vectorOf(pose.up));
    addCamera(std::move(camera), doublesOf(turn * vectorOf(pose.forward)));
  };
  if (collada_) {
    AssimpCamera pose;
    pose.up = {0, 1, 0};
    pose.forward = {0, 0, -1};
    for (const Camera& c : collada_->of(node.collada_id, node.name)) add(c, pose);
    return;
  }
  const auto [first, last] = camera_of_.equal_range(node.name);
  for (auto it = first; it != last; ++it) {
    const AssimpCamera& given = *it->second;
    // Assimp loses their targets.
    if (lowerExtension(scene_.file) == ".3ds") {
      notes_.add("cameras of 3DS files are not used", given.node, Severity::warning);
      continue;
    }
    Camera camera;
    camera.aspect = std::max(0.0, double(given.aspect));
    const double width = std::tan(0.5 * double(given.horizontal_angle));
    // If the file does not give the height of the picture, we take 4 : 3.
    camera.vertical_fov = 2 * std::atan(width / (camera.aspect > 0 ? camera.aspect : 4.0 / 3));
    add(std::move(camera), given);
  }
}

/// `camera` has everything but a target.
void AssimpReader::addCamera(Camera camera, const Vec3& forward) {
  const bool usable = isFinite(camera.eye) && isFinite(forward) &&
                      glm::length(glm::cross(forward, camera.up)) > 0 && camera.vertical_fov > 0 &&
                      camera.vertical_fov < std::numbers::pi;
  if (!usable) {
    notes_.add("cameras without a view direction or an angle are not used", camera.name,
               Severity::warning);
    return;
  }
  camera.target = camera.eye + glm::normalize(forward);
  camera.up = glm::normalize(camera.up);
  scene_.cameras.push_back(std::move(camera));
}

}  // namespace

namespace {

/// Refuses a truncated 3DS file, which Assimp reads as if it were complete. The first chunk has the
/// length.
void requireWhole3ds(const std::string& path) {
  const std::string content = readWholeFile(path);
  MeshCursor cursor(path, content);
  cursor.setEncoding(Encoding::little);
  constexpr long long kMainChunk = 0x4D4D;
  if (cursor.integer(NumberType::u16, "chunk") != kMainChunk) {
    throw InputError(path + ": is no 3DS file; export it again");
  }
  const long long length = cursor.integer(NumberType::u32, "length");
  if (length > static_cast<long long>(content.size())) {
    throw InputError(
        fmt::format("{}: is cut off: it says that it has {} bytes and has {}; export it "
                    "again",
                    path, length, content.size()));
  }
}

}  // namespace

Scene loadAssimp(const std::string& path, const SceneOptions& options) {
  const std::string extension = lowerExtension(path);
  if (extension == ".3ds") requireWhole3ds(path);
  if (extension == ".fbx") checkFbxNesting(path, readWholeFile(path));
  return AssimpReader(path, options).read();
}

}  // namespace radiosity
