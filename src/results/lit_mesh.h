// The readers of meshes with vertex colours, one for each format.
#pragma once

#include <string>

#include "radiosity/results.h"

namespace radiosity {

LitMesh readLitGltf(const std::string& path);
LitMesh readLitPly(const std::string& path);
LitMesh readLitObj(const std::string& path);

/// Appends a polygon of vertices with colours as a fan of triangles: one face.
void appendLitFace(LitMesh& mesh, std::span<const Index> corners, std::span<const Vec3> colours,
                   Index surface);

}  // namespace radiosity
