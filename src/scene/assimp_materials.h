// Materials of a file that Assimp reads, with the textures of their diffuse colours.
#pragma once

#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

struct aiScene;

namespace radiosity {

/// What has become of a material of the file.
struct AssimpMaterial {
  Index index;   ///< into Scene::materials
  unsigned set;  ///< of texture coordinates, which its texture takes
};

/// Adds all materials to `scene` and returns what has become of each, in the file's order: those of
/// one name that are alike in all that is used are one. What is not used goes to `ignored`. Diffuse
/// and emissive colours are read as those of an MTL file; a reflectance is the colour's, also
/// beside a texture. Errors: InputError naming the material.
std::vector<AssimpMaterial> readAssimpMaterials(const aiScene& file, const SceneOptions& options,
                                                Scene& scene, FeatureNotes& ignored);

}  // namespace radiosity
