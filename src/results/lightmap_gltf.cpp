#include "results/lightmap_gltf.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <string_view>

#include "radiosity/spelling.h"
#include "results/glb.h"
#include "results/gltf_bytes.h"
#include "scene/gltf/glb_chunks.h"
#include "scene/gltf/gltf_nodes.h"
#include "scene/gltf/gltf_placement.h"
#include "scene/gltf/gltf_preflight.h"

namespace radiosity {
namespace {

using Json = LightmapGltf::Json;

/// The relative tolerance of the file's coordinates, which are floats.
constexpr double kSamePlace = 1e-5;

Json documentOf(const std::string& source) {
  const std::string content = readGltf(source);
  try {
    return Json::parse(gltfJson(source, content));
  } catch (const nlohmann::json::exception&) {
    throw InputError(source + ": its JSON cannot be read; export the scene again");
  }
}

bool isDirection(const std::string& attribute) {
  return attribute == "NORMAL" || attribute == "TANGENT";
}

}  // namespace

LightmapGltf::LightmapGltf(const std::string& source, const Scene& scene, const Lightmap& map)
    : file_(parseGltf(source)), scene_(scene), map_(map), document_(documentOf(source)) {
  for (std::vector<Index>& of_side : of_face_) of_side.assign(scene.faceCount(), kNone);
  for (std::size_t k = 0; k < map.triangles.size(); ++k) {
    of_face_[map.triangles[k].side][map.triangles[k].face] = Index(k);
  }
  joinBuffers();
  embedImages();
  chooseSet();
  addMeshes();
  document_["asset"]["generator"] = "radiosity";
}

/// Joins all buffers, since a binary file has one. Drops what extensions add about the others (a
/// second, compressed form).
void LightmapGltf::joinBuffers() {
  std::vector<std::size_t> begin;
  for (const tinygltf::Buffer& buffer : file_.model.buffers) {
    binary_.resize(paddedTo4(binary_.size()));
    begin.push_back(binary_.size());
    binary_.insert(binary_.end(), buffer.data.begin(), buffer.data.end());
  }
  // We add the lists now, since a list that is added later moves the others.
  for (const char* list : {"bufferViews", "accessors"}) {
    if (!document_.contains(list)) document_[list] = Json::array();
  }
  for (Json& view : document_["bufferViews"]) {
    const auto buffer = view.at("buffer").get<std::size_t>();
    if (buffer >= begin.size()) file_.fail("a buffer view has no buffer; export the scene again");
    view["byteOffset"] = view.value("byteOffset", std::size_t(0)) + begin[buffer];
    view["buffer"] = 0;
    view.erase("extensions");
  }
}

/// Embeds images, since the new file may be in another folder. Missing images keep their names.
void LightmapGltf::embedImages() {
  for (std::size_t k = 0; k < file_.model.images.size(); ++k) {
    Json& image = document_["images"][k];
    if (!image.contains("uri")) continue;
    const auto bytes = file_.imageBytes(file_.model.images[k], "an image");
    const std::string type = mimeTypeOf(bytes);
    if (type.empty()) continue;
    image["bufferView"] = addView({bytes.begin(), bytes.end()}, 0, 0);
    image["mimeType"] = type;
    if (!image.contains("name") && !image["uri"].get<std::string>().starts_with("data:")) {
      image["name"] = image["uri"];
    }
    image.erase("uri");
  }
}

void LightmapGltf::chooseSet() {
  for (const tinygltf::Mesh& mesh : file_.model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      while (primitive.attributes.contains(fmt::format("TEXCOORD_{}", set_))) ++set_;
    }
  }
}

/// Adds meshes in the order in which the scene was read. A mesh of several nodes becomes one mesh
/// for each node or copy.
void LightmapGltf::addMeshes() {
  const Json given = document_.value("meshes", Json::array());
  std::vector<bool> used(given.size(), false);
  std::size_t face = 0;
  const GltfPlacement placement(file_);
  forEachGltfNode(file_, [&](int number, const glm::dmat4&, const std::string& what) {
    const tinygltf::Node& node = file_.model.nodes[std::size_t(number)];
    if (node.mesh < 0) return;
    const auto m = std::size_t(node.mesh);
    const std::vector<glm::dmat4> places = placement.copiesInNode(number, what);
    std::vector<std::size_t> indices;
    for (Json& mesh : meshesOf(number, given[m], placement, what, face)) {
      const std::size_t index = used[m] ? document_["meshes"].size() : m;
      used[m] = true;
      document_["meshes"][index] = std::move(mesh);
      indices.push_back(index);
    }
    if (node.extensions.contains(kGltfInstancing)) {
      addCopies(number, indices, places);
    } else {
      document_["nodes"][std::size_t(number)]["mesh"] = indices[0];
    }
  });
  if (face != scene_.faceCount()) failForOtherScene();
  forgetInstancing();
}

/// The mesh of a node, or one for each of its copies. `face`: the scene's first of them; moves on
/// to the next after them.
std::vector<LightmapGltf::Json> LightmapGltf::meshesOf(int number, const Json& given,
                                                       const GltfPlacement& placement,
                                                       const std::string& what, std::size_t& face) {
  const std::vector<glm::dmat4> copies = placement.copies(number, what);
  std::vector<Json> meshes(copies.size(), given);
  for (Json& mesh : meshes) mesh["primitives"] = Json::array();
  const tinygltf::Mesh& mesh =
      file_.at(file_.model.meshes, file_.model.nodes[std::size_t(number)].mesh, "mesh", what);
  for (std::size_t k = 0; k < mesh.primitives.size(); ++k) {
    for (std::size_t c = 0; c < copies.size(); ++c) {
      for (Json& one : primitivesOf(mesh.primitives[k], given["primitives"][k], placement, number,
                                    copies[c], what, face)) {
        meshes[c]["primitives"].push_back(std::move(one));
      }
    }
  }
  return meshes;
}

/// The primitives that replace one of a node's copy.
LightmapGltf::Json LightmapGltf::primitivesOf(const tinygltf::Primitive& primitive,
                                              const Json& given, const GltfPlacement& placement,
                                              int number, const glm::dmat4& copy,
                                              const std::string& what, std::size_t& face) {
  if (!hasTriangles(primitive) || !primitive.attributes.contains("POSITION")) {
    return Json::array({given});
  }
  const std::vector<Vec3> positions = placement.positions(number, primitive, copy, what);
  const bool mirrored = placement.isMirrored(number, copy);
  Placed placed{primitive,
                positions.size(),
                readGltfTriangles(file_, primitive, positions.size(), mirrored, what),
                mirrored,
                face,
                what};
  face += placed.corners.size() / 3;
  if (!isInScene(placed, positions)) failForOtherScene();
  return addPrimitives(given, placed);
}

/// Whether the scene's faces have the corners of a primitive, in the same order.
bool LightmapGltf::isInScene(const Placed& placed, std::span<const Vec3> positions) const {
  for (std::size_t k = 0; k < placed.corners.size(); ++k) {
    const std::size_t face = placed.first_face + k / 3;
    if (face >= scene_.faceCount() || scene_.face(face).size() != 3) return false;
    const Vec3& there = positions[placed.corners[k]];
    const Vec3& here = scene_.vertices[scene_.face(face)[k % 3]];
    if (glm::distance(here, there) > kSamePlace * (1 + glm::length(there))) return false;
  }
  return true;
}

void LightmapGltf::failForOtherScene() const {
  file_.fail(
      fmt::format("has changed since the scene was read from it, or the scene has faces turned "
                  "over or left out ({}, {}); start again",
                  spelled("flip"), spelled("without")));
}

/// Makes the copies of a node its children, with what belongs to a mesh.
void LightmapGltf::addCopies(int number, std::span<const std::size_t> meshes,
                             std::span<const glm::dmat4> places) {
  Json& nodes = document_["nodes"];
  Json node = nodes[std::size_t(number)];
  for (std::size_t copy = 0; copy < meshes.size(); ++copy) {
    Json matrix = Json::array();
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 4; ++row) matrix.push_back(places[copy][column][row]);
    }
    Json child = {{"mesh", meshes[copy]}, {"matrix", std::move(matrix)}};
    for (const char* of_mesh : {"name", "skin", "weights"}) {
      if (nodes[std::size_t(number)].contains(of_mesh)) {
        child[of_mesh] = nodes[std::size_t(number)][of_mesh];
      }
    }
    node["children"].push_back(nodes.size());
    nodes.push_back(std::move(child));
  }
  for (const char* of_mesh : {"mesh", "skin", "weights"}) node.erase(of_mesh);
  node["extensions"].erase(kGltfInstancing);
  if (node["extensions"].empty()) node.erase("extensions");
  nodes[std::size_t(number)] = std::move(node);
}

/// Removes the extension from the file's lists if no node has it any more.
void LightmapGltf::forgetInstancing() {
  for (const Json& node : document_.value("nodes", Json::array())) {
    if (node.contains("extensions") && node["extensions"].contains(kGltfInstancing)) return;
  }
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (!document_.contains(list)) continue;
    Json& names = document_[list];
    for (std::size_t k = names.size(); k-- > 0;) {
      if (names[k] == kGltfInstancing) names.erase(k);
    }
    if (names.empty()) document_.erase(list);
  }
}

/// The front's primitive and, if backs have light of their own, the back's.
LightmapGltf::Json LightmapGltf::addPrimitives(const Json& given, const Placed& placed) {
  const Part front = partOf(placed, 0);
  const Part back = partOf(placed, 1);
  Json result = Json::array();
  result.push_back(isOneToOne(front, placed.vertices) ? keptPrimitive(given, placed, front)
                                                      : newPrimitive(given, placed, front, false));
  if (back.corners.empty()) return result;
  result.push_back(newPrimitive(given, placed, back, true));
  if (placed.primitive.material < 0) return result;
  for (Json& primitive : result) primitive["material"] = oneSided(placed.primitive.material);
  return result;
}

void LightmapGltf::addCorner(Part& part, Index vertex, const LightmapTriangle* triangle,
                             std::size_t k) const {
  const Index chart = triangle == nullptr ? kNone : triangle->chart;
  const auto [place, fresh] = part.known.try_emplace({vertex, chart}, Index(part.copy_of.size()));
  if (fresh) {
    part.copy_of.push_back(vertex);
    const Vec2 uv = triangle == nullptr ? Vec2(0.0) : triangle->texcoord[k];
    part.texcoord.push_back({float(uv.x), float(uv.y)});
  }
  part.corners.push_back(place->second);
}

/// The part of one side: all fronts, although those without area have no chart, or the backs that
/// have one.
LightmapGltf::Part LightmapGltf::partOf(const Placed& placed, int side) const {
  Part part;
  for (std::size_t t = 0; t < placed.corners.size() / 3; ++t) {
    const Index number = of_face_[std::size_t(side)][placed.first_face + t];
    if (number == kNone && side == 1) continue;
    const LightmapTriangle* triangle = number == kNone ? nullptr : &map_.triangles[number];
    // Corners in the order of the file's fronts: a mirrored node turns it over, and so does the
    // view from behind.
    std::array<std::size_t, 3> order = {0, 1, 2};
    if (triangle != nullptr) {
      for (std::size_t k = 0; k < 3; ++k) order[k] = triangle->corner[k];
    }
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = placed.mirrored ? (3 - j) % 3 : j;
      addCorner(part, placed.corners[3 * t + order[k]], triangle, k);
    }
  }
  return part;
}

/// Whether every vertex is in one chart, so that the file's own vertices can be kept.
bool LightmapGltf::isOneToOne(const Part& part, std::size_t vertices) {
  std::vector<std::uint8_t> seen(vertices);
  for (const Index v : part.copy_of) {
    if (std::exchange(seen[v], 1) != 0) return false;
  }
  return true;
}

LightmapGltf::Json LightmapGltf::keptPrimitive(Json primitive, const Placed& placed,
                                               const Part& part) {
  std::vector<std::array<float, 2>> texcoords(placed.vertices, std::array<float, 2>{});
  for (std::size_t k = 0; k < part.copy_of.size(); ++k) {
    texcoords[part.copy_of[k]] = part.texcoord[k];
  }
  nameSets(primitive["attributes"], addTexcoords(texcoords));
  return primitive;
}

LightmapGltf::Json LightmapGltf::newPrimitive(Json primitive, const Placed& placed,
                                              const Part& part, bool turned) {
  primitive.erase("mode");  // triangles, which is the default
  copyAttributes(primitive["attributes"], placed.primitive.attributes, placed, part, turned);
  nameSets(primitive["attributes"], addTexcoords(part.texcoord));
  for (std::size_t k = 0; k < placed.primitive.targets.size(); ++k) {
    copyAttributes(primitive["targets"][k], placed.primitive.targets[k], placed, part, turned);
  }
  primitive["indices"] = addIndices(part.corners);
  return primitive;
}

/// Copies attributes. Normals and tangents of backs are reversed, and so is a tangent's fourth
/// number, the sign of its bitangent.
void LightmapGltf::copyAttributes(Json& attributes, const std::map<std::string, int>& given,
                                  const Placed& placed, const Part& part, bool turned) {
  for (const auto& [name, accessor] : given) {
    const std::string what = placed.what + ": " + name;
    const tinygltf::Accessor& like = file_.at(file_.model.accessors, accessor, "accessor", what);
    const int width = tinygltf::GetNumComponentsInType(std::uint32_t(like.type));
    const std::vector<double> values = file_.readNumbers(accessor, width, what);
    const auto components = std::size_t(width);
    if (values.size() != placed.vertices * components) {
      file_.fail(fmt::format("{} has {} elements for {} vertices; export the scene again", what,
                             values.size() / components, placed.vertices));
    }
    const double sign = turned && isDirection(name) ? -1 : 1;
    std::vector<double> copied;
    copied.reserve(part.copy_of.size() * components);
    for (const Index v : part.copy_of) {
      for (std::size_t c = 0; c < components; ++c)
        copied.push_back(sign * values[v * components + c]);
    }
    attributes[name] = addAccessor(copied, like, name == "POSITION");
  }
}

/// Sets are numbered without gaps (glTF 2.0, 3.7.2.1): missing earlier sets get these coordinates,
/// too.
void LightmapGltf::nameSets(Json& attributes, int texcoords) const {
  for (int k = 0; k <= set_; ++k) {
    const std::string name = fmt::format("TEXCOORD_{}", k);
    if (!attributes.contains(name)) attributes[name] = texcoords;
  }
}

/// A one-sided copy of the material: the other side has a primitive of its own.
int LightmapGltf::oneSided(int material) {
  const auto [copy, fresh] = one_sided_.try_emplace(material, 0);
  if (!fresh) return copy->second;
  Json& materials = document_["materials"];
  copy->second = int(materials.size());
  Json changed = materials[std::size_t(material)];
  changed.erase("doubleSided");
  materials.push_back(std::move(changed));
  return copy->second;
}

/// `target`, `stride`: 0 to leave them out.
int LightmapGltf::addView(const std::vector<char>& bytes, int target, std::size_t stride) {
  binary_.resize(paddedTo4(binary_.size()));
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  if (target != 0) view["target"] = target;
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  document_["bufferViews"].push_back(std::move(view));
  return int(document_["bufferViews"].size()) - 1;
}

/// Each attribute begins at a multiple of 4 bytes (glTF 2.0, 3.6.2.4).
int LightmapGltf::addAccessor(std::span<const double> values, const tinygltf::Accessor& like,
                              bool with_bounds) {
  const auto width = std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(like.type)));
  const auto size =
      std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(like.componentType)));
  const std::size_t stride = paddedTo4(width * size);
  const std::size_t count = values.size() / width;
  std::vector<char> bytes(count * stride);
  std::vector<double> low(width, std::numeric_limits<double>::infinity());
  std::vector<double> high(width, -std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double stored = storeComponent(values[k], like.componentType, like.normalized,
                                         &bytes[k / width * stride + k % width * size]);
    low[k % width] = std::min(low[k % width], stored);
    high[k % width] = std::max(high[k % width], stored);
  }
  Json accessor = {{"bufferView", addView(bytes, kGltfArrayBuffer, stride)},
                   {"componentType", like.componentType},
                   {"count", count},
                   {"type", gltfTypeName(like.type)}};
  if (like.normalized) accessor["normalized"] = true;
  if (with_bounds) {
    accessor["min"] = low;
    accessor["max"] = high;
  }
  document_["accessors"].push_back(std::move(accessor));
  return int(document_["accessors"].size()) - 1;
}

int LightmapGltf::addTexcoords(std::span<const std::array<float, 2>> values) {
  std::vector<double> numbers;
  numbers.reserve(2 * values.size());
  for (const auto& uv : values) numbers.insert(numbers.end(), {uv[0], uv[1]});
  tinygltf::Accessor like;
  like.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
  like.type = TINYGLTF_TYPE_VEC2;
  return addAccessor(numbers, like, false);
}

int LightmapGltf::addIndices(std::span<const Index> values) {
  std::vector<char> bytes(values.size_bytes());
  std::memcpy(bytes.data(), values.data(), bytes.size());
  document_["accessors"].push_back({{"bufferView", addView(bytes, kGltfElementArrayBuffer, 0)},
                                    {"componentType", kGltfUnsignedInt},
                                    {"count", values.size()},
                                    {"type", "SCALAR"}});
  return int(document_["accessors"].size()) - 1;
}

/// Adds the lightmap to the scene's own extras.
void LightmapGltf::setExtras(const Json& extras) {
  if (!document_.contains("scenes") || document_["scenes"].empty()) {
    document_["asset"]["extras"]["lightmap"] = extras;
    return;
  }
  const auto shown = std::size_t(std::max(file_.model.defaultScene, 0));
  Json& own = document_["scenes"][shown]["extras"];
  if (!own.is_object()) own = own.is_null() ? Json::object() : Json{{"extras", own}};
  own["lightmap"] = extras;
}

void LightmapGltf::write(const std::string& path) const {
  std::vector<char> padded = binary_;
  padded.resize(paddedTo4(padded.size()));
  writeGlb(path, document_, padded);
}

}  // namespace radiosity
