// Lamps with IES profiles in a glTF file (EXT_lights_ies).
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"

namespace radiosity {

inline constexpr const char* kGltfPhotometry = "EXT_lights_ies";

/// They share the profiles, each of which is read once.
class GltfLamps {
 public:
  /// `file` must outlive it.
  explicit GltfLamps(const GltfFile& file) : file_(file) {}

  /// The lamp of a node that has the extension, without a name. It points along the node's -z, and
  /// the plane of horizontal angle 0 is that of x and z; `transform` is to the world. Errors:
  /// InputError naming node or file.
  Light read(const tinygltf::Node& node, const glm::dmat4& transform, const std::string& what);
  /// Of the profiles that were read, a line each.
  std::vector<std::string> remarks() const;

 private:
  const LampFile& profile(const tinygltf::Value& number, const std::string& what);

  const GltfFile& file_;
  std::map<int, LampFile> profiles_;  ///< by their number in the file
};

}  // namespace radiosity
