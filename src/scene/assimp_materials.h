// Materials of a file that Assimp reads, with the textures of their diffuse colours.
#pragma once

#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

struct aiScene;

namespace radiosity {

/// Adds all materials to `scene`, in the file's order; what is not used goes to `ignored`. Returns
/// for each the set of texture coordinates that its texture takes (0 where it has none). Diffuse
/// and emissive colours are read as those of an MTL file; a reflectance is the colour's, also
/// beside a texture. Errors: InputError naming the material.
std::vector<unsigned> readAssimpMaterials(const aiScene& file, const SceneOptions& options,
                                          Scene& scene, FeatureNotes& ignored);

}  // namespace radiosity
