// Reads materials and textures of a glTF file.
#pragma once

#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// The source of a material's texture coordinates: TEXCOORD_set, then KHR_texture_transform.
struct TexcoordSource {
  int set = 0;
  Vec2 offset{0.0};
  Vec2 scale{1.0};
  double rotation = 0;
  Vec2 apply(const Vec2& uv) const;
  bool operator==(const TexcoordSource&) const = default;
};

struct GltfMaterials {
  std::vector<bool> unlit;                ///< one per material: its colours are light
  std::vector<TexcoordSource> texcoords;  ///< one per material of the scene
  Index none = kNone;                     ///< the default material; kNone until one is needed
};

/// Fills scene.materials (in the file's order, with unique names) and scene.textures.
GltfMaterials readGltfMaterials(const GltfFile& file, const SceneOptions& options, Scene& scene,
                                FeatureNotes& ignored);

}  // namespace radiosity
