// The file formats.
#pragma once

#include <string>

#include "radiosity/scene.h"

namespace radiosity {

/// Wavefront OBJ with its MTL files; file units, overrides not yet applied.
Scene loadObj(const std::string& path, const SceneOptions& options);

/// glTF 2.0, .gltf or .glb; metres, overrides not yet applied.
Scene loadGltf(const std::string& path, const SceneOptions& options);

/// STL, ASCII or binary by the content; file units, overrides not yet applied.
Scene loadStl(const std::string& path, const SceneOptions& options);

}  // namespace radiosity
