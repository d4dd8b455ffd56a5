// Rewrites AC3D for Assimp, which takes the last texture of an object for its only one and stops at
// names without quotes: objects of TORCS (.acc) have a texture for each of four layers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "scene/scene_builder.h"

namespace radiosity {

/// The content with the textures of base layers alone; others are noted.
std::string rewriteAc3d(std::string_view content, FeatureNotes& notes);

/// The number of faces that are two-sided in the file, which Assimp does not tell.
std::size_t twoSidedFacesOfAc3d(std::string_view content);

}  // namespace radiosity
