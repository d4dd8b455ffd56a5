#include "interchange/serialized_meshes.h"

#include <zlib.h>

#include <bit>
#include <cstdint>

#include "base/byte_stream.h"

namespace radiosity {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

constexpr std::uint16_t kFileMark = 0x041c;
constexpr std::uint16_t kFileVersion = 4;
constexpr std::uint32_t kHasTexcoords = 0x0002;
constexpr std::uint32_t kFaceNormals = 0x0010;
constexpr std::uint32_t kDoublePrecision = 0x2000;

/// What stands packed in the file.
std::vector<std::byte> plainMesh(const SurfaceTriangles& mesh, const std::string& name) {
  ByteWriter out;
  out.put(kFaceNormals | kDoublePrecision | (mesh.texcoords.empty() ? 0 : kHasTexcoords));
  for (const char c : name) out.put(c);
  out.put('\0');
  out.put(std::uint64_t(mesh.vertices.size()));
  out.put(std::uint64_t(mesh.triangles.size()));
  for (const Vec3& v : mesh.vertices) out.put(v);
  for (const Vec2& t : mesh.texcoords) out.put(t);
  for (const std::array<Index, 3>& t : mesh.triangles) {
    for (const Index v : t) out.put(std::uint32_t(v));
  }
  return out.take();
}

std::vector<std::byte> packed(std::span<const std::byte> data) {
  uLongf size = compressBound(uLong(data.size()));
  std::vector<std::byte> out(size);
  if (compress(reinterpret_cast<Bytef*>(out.data()), &size,
               reinterpret_cast<const Bytef*>(data.data()), uLong(data.size())) != Z_OK) {
    throw RunError("the meshes do not fit into memory when they are packed; free some");
  }
  out.resize(size);
  return out;
}

}  // namespace

std::vector<std::byte> serializedMeshes(std::span<const SurfaceTriangles> meshes,
                                        std::span<const std::string> names) {
  ByteWriter out;
  std::vector<std::uint64_t> begins;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    begins.push_back(out.bytes().size());
    out.put(kFileMark);
    out.put(kFileVersion);
    for (const std::byte b : packed(plainMesh(meshes[k], names[k]))) out.put(b);
  }
  for (const std::uint64_t begin : begins) out.put(begin);
  out.put(std::uint32_t(begins.size()));
  return out.take();
}

}  // namespace radiosity
