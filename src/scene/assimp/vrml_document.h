// Reads VRML 2.0 as X3D: the same nodes and fields in another notation.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "scene/scene_builder.h"

namespace radiosity {

/// The X3D document of a file: its nodes as elements, its fields as attributes or, if they hold
/// nodes, as elements inside. A .wrl that an Inline names gets .x3d
/// at its end, by which Assimp chooses its reader. Notes nodes that the file itself defines
/// (PROTO), which are left out. ISO/IEC 14772-1, annex A. Errors: those of readWholeFile(), and
/// InputError "PATH:LINE: what is wrong; cure" for text that is not VRML 2.0, or nodes nested more
/// than 200 deep.
pugi::xml_document readVrml(const std::string& path, FeatureNotes& notes);

}  // namespace radiosity
