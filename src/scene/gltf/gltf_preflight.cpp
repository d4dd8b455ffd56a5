#include "scene/gltf/gltf_preflight.h"

#include <fmt/format.h>

#include <vector>

#include "scene/gltf/glb_chunks.h"
#include "scene/gltf/gltf_file.h"
#include "scene/json_scan.h"
#include "scene/text.h"

namespace radiosity {

namespace {

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

std::string_view gltfJson(const std::string& path, std::string_view content) {
  return isGlb(content) ? glbChunks(path, content).json : content;
}

void checkGltf(const std::string& path, std::string_view content) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  std::string_view start = content.substr(0, 64);
  if (start.starts_with(kByteOrderMark)) start.remove_prefix(kByteOrderMark.size());
  if (!isGlb(content) && !trimmed(start).starts_with('{')) {
    throw InputError(path + ": is neither binary glTF nor a JSON object; export the scene again");
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
    if (!isSupportedGltfExtension(name) && !leavesGeometry(name)) unknown.push_back(name);
  }
  if (unknown.empty()) return;
  const bool one = unknown.size() == 1;
  throw InputError(fmt::format("{}: needs {}, which {} not supported; export without {}", path,
                               joinNames(unknown), one ? "is" : "are", one ? "it" : "them"));
}

}  // namespace radiosity
