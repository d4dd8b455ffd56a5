// Where the images of a scene are.
#pragma once

#include <string>

#include "scene/scene_builder.h"

namespace radiosity {

/// The path of the image that a file in `folder` calls `name`. Backslashes are taken for slashes.
/// Exporters write the path that an image had on their machine, and names in other letters than
/// the image's: where nothing is there, a file whose path differs in upper and lower case alone is
/// taken, or one of the same name in `folder`, which is noted. Nothing found: the path as named.
std::string findImage(const std::string& folder, const std::string& name, FeatureNotes& notes);

}  // namespace radiosity
