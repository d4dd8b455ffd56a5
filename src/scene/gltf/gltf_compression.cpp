#include "scene/gltf/gltf_compression.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/draco_codec.h"
#include "scene/gltf/glb_chunks.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/gltf_preflight.h"

namespace radiosity {

namespace {

using Json = nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// The most that a byte is unpacked to: 2 bits say that 16 bytes do not change
/// (EXT_meshopt_compression, "Attributes"); of indices it is less. A damaged size is refused before
/// memory is taken for it.
constexpr std::size_t kMostBytesOfOne = 64;
/// The most that a binary glTF file holds.
constexpr std::size_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

/// Replaces the compressed parts of a document by plain ones.
class GltfUnpacker {
 public:
  GltfUnpacker(const std::string& path, std::string_view content);

  std::string unpack();

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}; export the scene again", path_, what));
  }

  void readBuffers(std::string_view content);
  Bytes unpacked(const Json& packed, const std::string& what) const;
  void unpackView(Json& view, const std::string& what);
  void unpackPrimitive(Json& primitive, const std::string& what);
  void unpackAttribute(const DracoMesh& mesh, std::uint32_t id, Json& accessor,
                       const std::string& what);
  void keepIndices(const DracoMesh& mesh, Json& primitive);
  void forget(const char* extension);
  std::span<const unsigned char> bytesOf(const Json& place, const std::string& what) const;
  std::size_t keep(std::span<const unsigned char> bytes);
  std::size_t addView(std::span<const unsigned char> bytes);

  const std::string& path_;
  Json document_;
  std::vector<std::span<const unsigned char>> buffers_;
  GltfFile source_;                              ///< owns the buffers
  Bytes data_;                                   ///< the one buffer of the result
  std::map<std::size_t, std::size_t> place_of_;  ///< in it, by buffer
  std::map<std::size_t, std::shared_ptr<const DracoMesh>> meshes_;  ///< by compressed buffer view
};

/// A file with other JSON and the same binary chunk.
std::string withJson(const std::string& path, std::string_view content, const std::string& json) {
  const std::string_view binary = isGlb(content) ? glbChunks(path, content).binary : "";
  if (binary.empty()) return json;
  return glbBeginning(path, json, binary.size()).append(binary);
}

bool isFallback(const Json& buffer) {
  return buffer.contains("extensions") && buffer["extensions"].contains(kMeshopt);
}

GltfUnpacker::GltfUnpacker(const std::string& path, std::string_view content)
    : path_(path), document_(Json::parse(gltfJson(path, content))) {
  readBuffers(content);
}

/// Reads the buffers that have data. One that would hold the unpacked data has none.
void GltfUnpacker::readBuffers(std::string_view content) {
  Json& given = document_["buffers"];
  if (!given.is_array()) fail("has compressed geometry and no buffers");
  Json with_data = Json::array();
  std::vector<std::size_t> number;
  for (std::size_t k = 0; k < given.size(); ++k) {
    if (isFallback(given[k])) continue;
    number.push_back(k);
    with_data.push_back(given[k]);
  }
  const Json parts = {{"asset", {{"version", "2.0"}}}, {"buffers", with_data}};
  source_ = parseGltfContent(path_, withJson(path_, content, parts.dump()));
  buffers_.resize(given.size());
  for (std::size_t k = 0; k < number.size(); ++k) {
    buffers_[number[k]] = source_.model.buffers[k].data;
  }
}

/// The bytes that an object with "buffer", "byteOffset" and "byteLength" stands for.
std::span<const unsigned char> GltfUnpacker::bytesOf(const Json& place,
                                                     const std::string& what) const {
  const auto buffer = place.at("buffer").get<std::size_t>();
  const auto offset = place.value("byteOffset", std::size_t(0));
  const auto length = place.at("byteLength").get<std::size_t>();
  if (buffer >= buffers_.size()) fail(fmt::format("{} has no buffer", what));
  const std::span<const unsigned char> all = buffers_[buffer];
  if (offset > all.size() || length > all.size() - offset) {
    fail(fmt::format("{} reaches beyond the end of its buffer", what));
  }
  return all.subspan(offset, length);
}

/// Appends to the new buffer; returns the offset there.
std::size_t GltfUnpacker::keep(std::span<const unsigned char> bytes) {
  data_.resize(paddedTo4(data_.size()));
  const std::size_t offset = data_.size();
  // Packed data may stand for much, and several views for the same.
  if (bytes.size() > kMostBytes - std::min(offset, kMostBytes)) {
    throw InputError(path_ +
                     ": its geometry takes more than 4 GiB without compression; split the scene");
  }
  data_.insert(data_.end(), bytes.begin(), bytes.end());
  return offset;
}

std::size_t GltfUnpacker::addView(std::span<const unsigned char> bytes) {
  document_["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", keep(bytes)}, {"byteLength", bytes.size()}});
  return document_["bufferViews"].size() - 1;
}

int decodeMeshopt(Bytes& out, const std::string& mode, std::size_t count, std::size_t stride,
                  std::span<const unsigned char> in) {
  const bool indices = (stride == 2 || stride == 4) && (mode == "INDICES" || count % 3 == 0);
  if (mode == "ATTRIBUTES" && stride >= 4 && stride <= 256 && stride % 4 == 0) {
    return meshopt_decodeVertexBuffer(out.data(), count, stride, in.data(), in.size());
  }
  if (mode == "TRIANGLES" && indices) {
    return meshopt_decodeIndexBuffer(out.data(), count, stride, in.data(), in.size());
  }
  if (mode == "INDICES" && indices) {
    return meshopt_decodeIndexSequence(out.data(), count, stride, in.data(), in.size());
  }
  return -1;
}

/// Undoes the filter of EXT_meshopt_compression; false if there is none of this name and size.
bool undoFilter(Bytes& out, const std::string& filter, std::size_t count, std::size_t stride) {
  if (filter == "NONE") return true;
  if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8)) {
    meshopt_decodeFilterOct(out.data(), count, stride);
  } else if (filter == "QUATERNION" && stride == 8) {
    meshopt_decodeFilterQuat(out.data(), count, stride);
  } else if (filter == "EXPONENTIAL" && stride % 4 == 0) {
    meshopt_decodeFilterExp(out.data(), count, stride);
  } else {
    return false;
  }
  return true;
}

/// The data of a view that meshoptimizer packed, as its extension says.
Bytes GltfUnpacker::unpacked(const Json& packed, const std::string& what) const {
  const std::span<const unsigned char> in = bytesOf(packed, what);
  const auto count = packed.at("count").get<std::size_t>();
  const auto stride = packed.at("byteStride").get<std::size_t>();
  if (count == 0 || stride == 0 || count > in.size() * kMostBytesOfOne / stride) {
    fail(fmt::format("{} cannot be {} elements of {} bytes", what, count, stride));
  }
  Bytes bytes(count * stride);
  if (decodeMeshopt(bytes, packed.at("mode").get<std::string>(), count, stride, in) != 0 ||
      !undoFilter(bytes, packed.value("filter", "NONE"), count, stride)) {
    fail(fmt::format("{} cannot be unpacked ({})", what, kMeshopt));
  }
  return bytes;
}

void GltfUnpacker::unpackView(Json& view, const std::string& what) {
  if (view.contains("extensions") && view["extensions"].contains(kMeshopt)) {
    const Bytes bytes = unpacked(view["extensions"][kMeshopt], what);
    view.erase("extensions");
    view["byteOffset"] = keep(bytes);
    view["byteLength"] = bytes.size();
  } else {
    // Views may overlap, so we keep each buffer whole, and once.
    bytesOf(view, what);
    const auto buffer = view["buffer"].get<std::size_t>();
    const auto [place, is_new] = place_of_.try_emplace(buffer, 0);
    if (is_new) place->second = keep(buffers_[buffer]);
    view["byteOffset"] = place->second + view.value("byteOffset", std::size_t(0));
  }
  view["buffer"] = 0;
}

std::optional<DracoNumber> numberOf(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return DracoNumber::int8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return DracoNumber::uint8;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return DracoNumber::int16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return DracoNumber::uint16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return DracoNumber::uint32;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return DracoNumber::float32;
    default:
      return std::nullopt;
  }
}

void GltfUnpacker::unpackPrimitive(Json& primitive, const std::string& what) {
  const Json packed = primitive["extensions"][kDraco];
  const auto number = packed.at("bufferView").get<std::size_t>();
  std::shared_ptr<const DracoMesh>& mesh = meshes_[number];
  if (!mesh) {
    const Json& views = document_["bufferViews"];
    if (number >= views.size()) fail(fmt::format("{} has no buffer view {}", what, number));
    const Json& view = views[number];
    mesh = dracoCodec().decode(std::span(data_).subspan(view.at("byteOffset").get<std::size_t>(),
                                                        view.at("byteLength").get<std::size_t>()));
    if (!mesh) fail(fmt::format("{} cannot be unpacked ({})", what, kDraco));
  }
  for (const auto& [name, id] : packed.at("attributes").items()) {
    const auto accessor = primitive.at("attributes").find(name);
    if (accessor == primitive.at("attributes").end()) continue;
    unpackAttribute(*mesh, id.get<std::uint32_t>(),
                    document_.at("accessors").at(accessor->get<std::size_t>()),
                    fmt::format("{}: {}", what, name));
  }
  keepIndices(*mesh, primitive);
  primitive["mode"] = TINYGLTF_MODE_TRIANGLES;
  primitive["extensions"].erase(kDraco);
  if (primitive["extensions"].empty()) primitive.erase("extensions");
}

void GltfUnpacker::unpackAttribute(const DracoMesh& mesh, std::uint32_t id, Json& accessor,
                                   const std::string& what) {
  const std::optional<DracoNumber> number = numberOf(accessor.at("componentType").get<int>());
  if (!number) fail(fmt::format("{} has no type of numbers", what));
  const DracoValues values = mesh.values(id, *number);
  if (values.components == 0) fail(fmt::format("{} cannot be unpacked ({})", what, kDraco));
  // Elements begin at multiples of 4 bytes (glTF 2.0, 3.6.2.4).
  const std::size_t width = values.bytes.size() / std::max<std::size_t>(1, mesh.points());
  const std::size_t stride = paddedTo4(width);
  Bytes bytes(mesh.points() * stride);
  for (std::size_t k = 0; k < mesh.points(); ++k) {
    std::memcpy(bytes.data() + k * stride, values.bytes.data() + k * width, width);
  }
  const std::size_t view = addView(bytes);
  document_["bufferViews"][view]["byteStride"] = stride;
  accessor["bufferView"] = view;
  accessor["byteOffset"] = 0;
  accessor["count"] = mesh.points();
}

void GltfUnpacker::keepIndices(const DracoMesh& mesh, Json& primitive) {
  const std::vector<std::uint32_t> corners = mesh.corners();
  const Json accessor = {
      {"bufferView", addView({reinterpret_cast<const unsigned char*>(corners.data()),
                              corners.size() * sizeof(std::uint32_t)})},
      {"componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT},
      {"count", corners.size()},
      {"type", "SCALAR"}};
  primitive["indices"] = document_["accessors"].size();
  document_["accessors"].push_back(accessor);
}

void GltfUnpacker::forget(const char* extension) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (!document_.contains(list)) continue;
    Json& names = document_[list];
    names.erase(std::remove(names.begin(), names.end(), Json(extension)), names.end());
    if (names.empty()) document_.erase(list);
  }
}

std::string GltfUnpacker::unpack() {
  Json& views = document_["bufferViews"];
  for (std::size_t k = 0; k < views.size(); ++k) {
    unpackView(views[k], fmt::format("buffer view {}", k));
  }
  for (std::size_t m = 0; m < document_["meshes"].size(); ++m) {
    Json& mesh = document_["meshes"][m];
    for (std::size_t k = 0; k < mesh.at("primitives").size(); ++k) {
      Json& primitive = mesh["primitives"][k];
      if (!primitive.contains("extensions") || !primitive["extensions"].contains(kDraco)) continue;
      unpackPrimitive(primitive,
                      fmt::format("mesh {}, primitive {}", mesh.value("name", Json(m).dump()), k));
    }
  }
  for (const char* extension : {kDraco, kMeshopt}) forget(extension);
  data_.resize(paddedTo4(data_.size()));
  document_["buffers"] = Json::array({{{"byteLength", data_.size()}}});
  const std::string json = document_.dump(-1, ' ', false, Json::error_handler_t::replace);
  return glbBeginning(path_, json, data_.size())
      .append(reinterpret_cast<const char*>(data_.data()), data_.size());
}

}  // namespace

bool isGltfCompression(const std::string& extension) {
  return extension == kDraco || extension == kMeshopt;
}

std::string gltfWithoutCompression(const std::string& path, std::string content) {
  const std::string_view json = gltfJson(path, content);
  if (json.find(kDraco) == json.npos && json.find(kMeshopt) == json.npos) return content;
  try {
    return GltfUnpacker(path, content).unpack();
  } catch (const Json::exception&) {
    throw InputError(path +
                     ": what its JSON says of compressed geometry cannot be read; export the scene "
                     "again");
  }
}

}  // namespace radiosity
