// Where the meshes of a glTF file lie: copies of a node, skins in their pose, morph targets.
#pragma once

#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "scene/gltf/gltf_file.h"

namespace radiosity {

/// The extension of nodes that have copies.
inline constexpr const char* kGltfInstancing = "EXT_mesh_gpu_instancing";

class GltfPlacement {
 public:
  /// Keeps a reference to the file. Errors: those of forEachGltfNode().
  explicit GltfPlacement(const GltfFile& file);

  /// The transforms of the copies of a node (kGltfInstancing), or its own alone.
  std::vector<glm::dmat4> copies(int node, const std::string& what) const;
  /// The same relative to the node; empty if the node has no copies but itself.
  std::vector<glm::dmat4> copiesInNode(int node, const std::string& what) const;

  /// The positions of a primitive's vertices in the world, all finite. `copy`: one of copies(). A
  /// skin is in the pose of its nodes (glTF 2.0, 3.7.3.3), and then the node's own transform does
  /// not count; morph targets have the file's weights.
  std::vector<Vec3> positions(int node, const tinygltf::Primitive& primitive,
                              const glm::dmat4& copy, const std::string& what) const;

  /// Whether the copy's triangles are turned over (glTF 2.0, 3.7.4).
  bool isMirrored(int node, const glm::dmat4& copy) const;

 private:
  bool isSkinned(int node) const;
  std::vector<glm::dmat4> jointTransforms(int node, const std::string& what) const;
  void addMorphTargets(int node, const tinygltf::Primitive& primitive, std::vector<double>& numbers,
                       const std::string& what) const;
  void bend(int node, const tinygltf::Primitive& primitive, std::vector<Vec3>& positions,
            const std::string& what) const;

  const GltfFile& file_;
  std::vector<glm::dmat4> world_;  ///< by node; the identity for nodes that are not in the scene
};

}  // namespace radiosity
