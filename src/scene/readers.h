// The two file formats.
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Wavefront OBJ with its MTL files; file units, overrides not yet applied.
Scene loadObj(const std::string& path, const SceneOptions& options);

/// glTF 2.0, .gltf or (`binary`) .glb; metres, overrides not yet applied.
Scene loadGltf(const std::string& path, bool binary, const SceneOptions& options);

}  // namespace radiosity
