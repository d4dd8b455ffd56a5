#include "scene/assimp/ac3d_document.h"

#include <algorithm>
#include <charconv>

#include "scene/text.h"

namespace radiosity {

namespace {

/// A line that begins with this: texture "name", in TORCS texture "name" layer.
constexpr std::string_view kTexture = "texture ";
/// SURF has type and flags.
constexpr std::string_view kFace = "SURF 0x";
constexpr unsigned kTwoSided = 0x20;

/// Whether the texture is an object's own; other layers are noted.
bool isBase(std::string_view line, FeatureNotes& notes) {
  const std::string_view after = trimmed(line.substr(kTexture.size()));
  if (!after.starts_with('"')) return false;  // TORCS: empty_texture_no_mapping
  const std::size_t end = after.find('"', 1);
  if (end == std::string_view::npos) return true;
  const std::string_view layer = trimmed(after.substr(end + 1));
  if (layer.empty() || layer == "base") return true;
  notes.add("layers of textures other than the base are not used, texture",
            std::string(after.substr(1, end - 1)), Severity::warning);
  return false;
}

}  // namespace

std::string rewriteAc3d(std::string_view content, FeatureNotes& notes) {
  std::string result;
  result.reserve(content.size());
  while (!content.empty()) {
    const std::size_t size = std::min(content.find('\n'), content.size() - 1) + 1;
    const std::string_view line = content.substr(0, size);
    if (!line.starts_with(kTexture) || isBase(line, notes)) result += line;
    content.remove_prefix(size);
  }
  return result;
}

std::size_t twoSidedFacesOfAc3d(std::string_view content) {
  std::size_t count = 0;
  for (std::size_t at = content.find(kFace); at != std::string_view::npos;
       at = content.find(kFace, at)) {
    at += kFace.size();
    unsigned flags = 0;
    std::from_chars(content.data() + at, content.data() + content.size(), flags, 16);
    if ((flags & kTwoSided) != 0) ++count;
  }
  return count;
}

}  // namespace radiosity
