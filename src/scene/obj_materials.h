// Materials of an OBJ: from its MTL files, or defaults where they are missing.
#pragma once

#include <map>
#include <string>

#include "scene/obj_scan.h"

namespace radiosity {

/// Reads the libraries `scan` names into scene.materials and scene.textures, adds a default
/// material for every used name that none defines, and says so in the scene's notes. Returns the
/// material of each entry of scan.materials.
std::vector<Index> readObjMaterials(const ObjScan& scan, const SceneOptions& options, Scene& scene);

}  // namespace radiosity
