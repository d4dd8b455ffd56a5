#include "results/glb.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "base/geometry/box.h"
#include "results/checked_file.h"
#include "scene/gltf/glb_chunks.h"

namespace radiosity {

Vec3 floatOrigin(std::span<const Vec3> vertices) {
  const Box3 box = boxOf(vertices);
  return glm::length(box.centre()) > box.diagonal() ? box.centre() : Vec3(0.0);
}

GlbWriter::GlbWriter(const Vec3& origin) : origin_(origin) {
  document_["asset"] = {{"version", "2.0"}, {"generator", "radiosity"}};
  document_["scene"] = 0;
  document_["scenes"] = Json::array({{{"nodes", Json::array()}}});
  for (const char* list : {"nodes", "meshes", "materials", "accessors", "bufferViews"}) {
    document_[list] = Json::array();
  }
}

int GlbWriter::addMaterial(Json material) {
  document_["materials"].push_back(std::move(material));
  return int(document_["materials"].size()) - 1;
}

void GlbWriter::addPosition(GlbVertices& vertices, const Vec3& metres) const {
  const Vec3 p = metres - origin_;
  vertices.position.push_back({float(p.x), float(p.y), float(p.z)});
}

int GlbWriter::addAccessor(const void* data, std::size_t bytes, std::size_t count, const char* type,
                           int component, int target) {
  const std::size_t offset = binary_.size();  // a multiple of 4: all components have 4 bytes
  const auto* first = static_cast<const char*>(data);
  binary_.insert(binary_.end(), first, first + bytes);
  Json& views = document_["bufferViews"];
  views.push_back(
      {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}, {"target", target}});
  Json& accessors = document_["accessors"];
  accessors.push_back({{"bufferView", int(views.size()) - 1},
                       {"componentType", component},
                       {"count", count},
                       {"type", type}});
  return int(accessors.size()) - 1;
}

int GlbWriter::addVectors(const std::vector<std::array<float, 3>>& values) {
  return addAccessor(values.data(), values.size() * sizeof values[0], values.size(), "VEC3",
                     kGltfFloat, kGltfArrayBuffer);
}

GlbWriter::Json GlbWriter::addPrimitive(const GlbVertices& vertices,
                                        std::span<const Index> triangles, int material) {
  const int position = addVectors(vertices.position);
  std::array<float, 3> lower = vertices.position[0];
  std::array<float, 3> upper = lower;
  for (const auto& p : vertices.position) {
    for (std::size_t c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], p[c]);
      upper[c] = std::max(upper[c], p[c]);
    }
  }
  document_["accessors"][std::size_t(position)]["min"] = lower;
  document_["accessors"][std::size_t(position)]["max"] = upper;
  Json attributes = {{"POSITION", position}};
  if (!vertices.colour.empty()) attributes["COLOR_0"] = addVectors(vertices.colour);
  if (!vertices.radiosity.empty()) attributes["_RADIOSITY"] = addVectors(vertices.radiosity);
  if (!vertices.lightmap.empty()) {
    const int texcoords = addAccessor(
        vertices.lightmap.data(), vertices.lightmap.size() * sizeof vertices.lightmap[0],
        vertices.lightmap.size(), "VEC2", kGltfFloat, kGltfArrayBuffer);
    attributes["TEXCOORD_0"] = texcoords;
    attributes["TEXCOORD_1"] = texcoords;
  }
  const int indices = addAccessor(triangles.data(), triangles.size_bytes(), triangles.size(),
                                  "SCALAR", kGltfUnsignedInt, kGltfElementArrayBuffer);
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", material}};
}

void GlbWriter::addNode(const std::string& name, std::vector<Json> primitives) {
  document_["meshes"].push_back({{"name", name}, {"primitives", std::move(primitives)}});
  Json node = {{"name", name}, {"mesh", int(document_["meshes"].size()) - 1}};
  if (origin_ != Vec3(0.0)) node["translation"] = {origin_.x, origin_.y, origin_.z};
  document_["nodes"].push_back(std::move(node));
  document_["scenes"][0]["nodes"].push_back(int(document_["nodes"].size()) - 1);
}

void GlbWriter::write(const std::string& path) const {
  if (document_["nodes"].empty()) {
    throw InputError(fmt::format("{}: the mesh has no triangle to write", path));
  }
  writeGlb(path, document_, binary_);
}

void writeGlb(const std::string& path, nlohmann::ordered_json document,
              std::span<const char> binary) {
  using Json = nlohmann::ordered_json;
  document["buffers"] = Json::array({{{"byteLength", binary.size()}}});
  // A name from an OBJ file need not be valid UTF-8, but JSON must be.
  const std::string json = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string beginning = glbBeginning(path, json, binary.size());
  CheckedFile file(path);
  file.write(beginning);
  file.write(binary.data(), binary.size());
  file.commit();
}

}  // namespace radiosity
