// The node tree of a glTF file and the triangles of its primitives.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"

namespace radiosity {

/// A scale, then a rotation (x, y, z, w), then a translation; null for none. Errors: a rotation
/// that is the zero quaternion.
glm::dmat4 gltfTransform(const GltfFile& file, const double* translation, const double* rotation,
                         const double* scale, const std::string& what);

/// Calls visit(node number, transform to the world, "node NAME") for every node of the default
/// scene (of all roots if there is none), parents first, children in their order. Errors: a node
/// that is reached twice, a malformed transform.
void forEachGltfNode(const GltfFile& file,
                     const std::function<void(int, const glm::dmat4&, const std::string&)>& visit);

/// True for a primitive of triangles, in any mode.
bool hasTriangles(const tinygltf::Primitive& primitive);

/// The vertices, three each, of the triangles of such a primitive, which has `vertices` vertices.
/// `mirrored`: they are turned over, so that fronts stay fronts where a node mirrors its mesh.
std::vector<Index> readGltfTriangles(const GltfFile& file, const tinygltf::Primitive& primitive,
                                     std::size_t vertices, bool mirrored, const std::string& what);

}  // namespace radiosity
