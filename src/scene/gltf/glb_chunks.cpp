#include "scene/gltf/glb_chunks.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "radiosity/base.h"

namespace radiosity {

namespace {

static_assert(std::endian::native == std::endian::little, "a GLB's numbers are read as they stand");

constexpr std::uint32_t kGlbMagic = 0x46546c67;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinaryChunk = 0x004e4942;
constexpr std::size_t kGlbHeader = 12;   // magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length, type

std::uint32_t wordAt(std::string_view content, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, content.data() + at, sizeof word);
  return word;
}

}  // namespace

bool isGlb(std::string_view content) {
  return content.size() >= sizeof kGlbMagic && wordAt(content, 0) == kGlbMagic;
}

GlbChunks glbChunks(const std::string& path, std::string_view content) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format("{}: {}; export the scene again", path, what));
  };
  if (content.size() < kGlbHeader + kChunkHeader) fail("the file is cut off within its header");
  const std::uint32_t version = wordAt(content, 4);
  if (version != 2) {
    throw InputError(fmt::format("{}: is binary glTF {}; export it as glTF 2.0", path, version));
  }
  const std::size_t length = wordAt(content, 8);
  if (length > content.size()) {
    fail(fmt::format("the file is cut off: it has {} of {} bytes", content.size(), length));
  }
  GlbChunks chunks;
  for (std::size_t at = kGlbHeader; at < length;) {
    if (length - at < kChunkHeader || wordAt(content, at) > length - at - kChunkHeader) {
      fail(fmt::format("the chunk at byte {} reaches beyond the end of the file", at));
    }
    const std::string_view chunk = content.substr(at + kChunkHeader, wordAt(content, at));
    const std::uint32_t type = wordAt(content, at + 4);
    if (at == kGlbHeader && type == kJsonChunk) chunks.json = chunk;
    if (at != kGlbHeader && type == kBinaryChunk && chunks.binary.empty()) chunks.binary = chunk;
    at += kChunkHeader + chunk.size();
  }
  if (chunks.json.data() == nullptr) fail("its first chunk is not JSON");
  return chunks;
}

std::string glbBeginning(const std::string& path, std::string_view json, std::size_t binary_size) {
  const std::size_t json_size = paddedTo4(json.size());
  const std::size_t total = kGlbHeader + 2 * kChunkHeader + json_size + binary_size;
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    throw RunError(
        fmt::format("{}: would take {} bytes, glTF binary holds 4 GiB; write less", path, total));
  }
  const std::array<std::uint32_t, 5> head = {kGlbMagic, 2, std::uint32_t(total),
                                             std::uint32_t(json_size), kJsonChunk};
  const std::array<std::uint32_t, 2> binary_head = {std::uint32_t(binary_size), kBinaryChunk};
  std::string beginning(reinterpret_cast<const char*>(head.data()), sizeof head);
  beginning += json;
  beginning.append(json_size - json.size(), ' ');
  return beginning.append(reinterpret_cast<const char*>(binary_head.data()), sizeof binary_head);
}

}  // namespace radiosity
