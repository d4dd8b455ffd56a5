// Lamps with IES profiles in a glTF file (EXT_lights_ies).
#pragma once

#include <glm/mat4x4.hpp>
#include <string>

#include "scene/gltf/gltf_file.h"

namespace radiosity {

inline constexpr const char* kGltfPhotometry = "EXT_lights_ies";

/// The lamp of a node that has the extension, without a name. It points along the node's -z, and
/// the plane of horizontal angle 0 is that of x and z; `transform` is to the world. Errors:
/// InputError naming node or file.
Light gltfPhotometricLight(const GltfFile& file, const tinygltf::Node& node,
                           const glm::dmat4& transform, const std::string& what);

}  // namespace radiosity
