#include "scene/gltf_preflight.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "scene/gltf_file.h"
#include "scene/json_scan.h"
#include "scene/text.h"

namespace radiosity {

namespace {

static_assert(std::endian::native == std::endian::little, "a GLB's numbers are read as they stand");

constexpr std::size_t kGlbHeader = 12;   // magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length, type
constexpr std::uint32_t kJson = 0x4e4f534a;

std::uint32_t wordAt(std::string_view content, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, content.data() + at, sizeof word);
  return word;
}

/// The JSON chunk of a .glb, whose chunks must lie within the file.
std::string_view jsonChunk(const std::string& path, std::string_view content) {
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
  for (std::size_t at = kGlbHeader; at < length;) {
    if (length - at < kChunkHeader || wordAt(content, at) > length - at - kChunkHeader) {
      fail(fmt::format("the chunk at byte {} reaches beyond the end of the file", at));
    }
    at += kChunkHeader + wordAt(content, at);
  }
  if (length < kGlbHeader + kChunkHeader || wordAt(content, kGlbHeader + 4) != kJson) {
    fail("its first chunk is not JSON");
  }
  return content.substr(kGlbHeader + kChunkHeader, wordAt(content, kGlbHeader));
}

/// The version and required extensions in the JSON.
struct Claims {
  bool is_object = false;
  std::string version;
  std::vector<std::string> required;
};

Claims readClaims(const std::string& path, std::string_view json) {
  Claims claims;
  scanJson(path, json, [&](std::span<const JsonStep> at, const JsonValue& value) {
    if (at.empty() && value.kind == JsonKind::object) claims.is_object = true;
    if (at.size() != 2 || value.kind != JsonKind::text) return;
    if (at[0].key == "asset" && at[1].key == "version") claims.version = value.text;
    if (at[0].key == "extensionsRequired") claims.required.emplace_back(value.text);
  });
  return claims;
}

}  // namespace

bool isGlb(std::string_view content) { return content.starts_with("glTF"); }

std::string_view gltfJson(const std::string& path, std::string_view content) {
  return isGlb(content) ? jsonChunk(path, content) : content;
}

void checkGltf(const std::string& path, std::string_view content) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string_view start = content.substr(0, 64);
  if (start.starts_with(kByteOrderMark)) start.remove_prefix(kByteOrderMark.size());
  if (!isGlb(content) && !trimmed(start).starts_with('{')) {
    throw InputError(path + ": is neither binary glTF nor JSON; export the scene again");
  }
  const Claims claims = readClaims(path, gltfJson(path, content));
  if (!claims.is_object || claims.version.empty()) {
    throw InputError(path + ": is not glTF (no asset version); export it as glTF 2.0");
  }
  if (!claims.version.starts_with("2.")) {
    throw InputError(fmt::format("{}: is glTF {}; export it as glTF 2.0", path, claims.version));
  }
  std::vector<std::string> unknown;
  for (const std::string& name : claims.required) {
    if (!isSupportedGltfExtension(name)) unknown.push_back(name);
  }
  if (unknown.empty()) return;
  const bool one = unknown.size() == 1;
  throw InputError(fmt::format("{}: needs {}, which {} not supported; export without {}", path,
                               joinNames(unknown), one ? "is" : "are", one ? "it" : "them"));
}

}  // namespace radiosity
