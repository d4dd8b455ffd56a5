// Reads the materials of Assimp's files, with the textures of their diffuse colours.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "radiosity/scene.h"
#include "scene/assimp/assimp_scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// A material of the file in the scene.
struct AssimpMaterial {
  Index index;      ///< into Scene::materials
  bool has_colour;  ///< false: its reflectance is the default
};

/// Adds all materials to `scene` and returns the scene's material of each, in the file's order.
/// `names`: if there are any, the names of the materials to be read, by number, instead of the
/// file's own; the index of others is kNone. Materials of one name, or without
/// one, are one if all properties that we use are equal. Unused properties go to `ignored`. Diffuse
/// and emissive colours are read as in an MTL file; the reflectance is the colour's, also beside a
/// texture. Errors: InputError naming the material.
std::vector<AssimpMaterial> readAssimpMaterials(const AssimpScene& file,
                                                const std::map<unsigned, std::string>& names,
                                                const SceneOptions& options, Scene& scene,
                                                FeatureNotes& ignored);

}  // namespace radiosity
