// The node tree of a glTF file and the triangles of its primitives.
#pragma once

#include <cmath>
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "base/finite.h"
#include "scene/gltf_file.h"

namespace radiosity {

/// Calls visit(node number, transform to the world, "node NAME") for every node of the default
/// scene (of all roots if there is none), parents first, children in their order. Errors: a node
/// that is reached twice, a malformed transform.
void forEachGltfNode(const GltfFile& file,
                     const std::function<void(int, const glm::dmat4&, const std::string&)>& visit);

/// True for a primitive of triangles, in any mode.
bool hasTriangles(const tinygltf::Primitive& primitive);

/// The vertices, three each, of the triangles of such a primitive, which has `vertices` vertices.
/// Fronts stay fronts under `transform`: a mirrored node reverses triangles (glTF 2.0, 3.7.4).
std::vector<Index> readGltfTriangles(const GltfFile& file, const tinygltf::Primitive& primitive,
                                     std::size_t vertices, const glm::dmat4& transform,
                                     const std::string& what);

/// The positions under `transform`, all finite.
std::vector<Vec3> readGltfPositions(const GltfFile& file, const tinygltf::Primitive& primitive,
                                    const glm::dmat4& transform, const std::string& what);

}  // namespace radiosity
