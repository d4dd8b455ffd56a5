// Reads the materials of an OBJ from its MTL files; missing ones get defaults.
#pragma once

#include <map>
#include <string>

#include "scene/obj/obj_scan.h"

namespace radiosity {

/// Reads the libraries in `scan` into scene.materials and scene.textures. Adds a default material
/// for every used name that no library defines, with a note in the scene. Returns the material of
/// each entry of scan.materials.
std::vector<Index> readObjMaterials(const ObjScan& scan, const SceneOptions& options, Scene& scene);

}  // namespace radiosity
