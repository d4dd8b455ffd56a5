// Finds the images of a scene.
#pragma once

#include <string>

#include "scene/scene_builder.h"

namespace radiosity {

/// The path of the image that a file in `folder` calls `name`. Backslashes count as slashes.
/// Exporters often write the path on their own machine, or a name in another case. If there is no
/// file at the path, we take one whose path differs only in case, or one of the same name in
/// `folder`, and note it. If none is found, returns the path as named.
std::string findImage(const std::string& folder, const std::string& name, FeatureNotes& notes);

}  // namespace radiosity
