// Reads the materials of Assimp's files, with the textures of their diffuse colours.
#pragma once

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
/// Materials of one name, or without one, are one if all properties that we use are equal. Unused
/// properties go to `ignored`. Diffuse and emissive colours are read as in an MTL file; the
/// reflectance is the colour's, also beside a texture. Errors: InputError naming the material.
std::vector<AssimpMaterial> readAssimpMaterials(const AssimpScene& file,
                                                const SceneOptions& options, Scene& scene,
                                                FeatureNotes& ignored);

}  // namespace radiosity
