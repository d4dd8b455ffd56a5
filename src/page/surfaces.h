// The parts of a mesh that a page draws: triangles, the shading of their corners, and outlines.
#pragma once

#include <vector>

#include "page/container.h"
#include "radiosity/patch_mesh.h"

namespace radiosity::page {

/// The weights of smooth shading: a shading vertex shows the mean of some patches by area, like
/// cornerValues().
struct ShadingVertices {
  std::vector<std::uint32_t> begin;  ///< S + 1, into the others
  std::vector<std::uint32_t> patch;
  std::vector<float> weight;          ///< sum to 1 in each vertex
  std::vector<std::uint32_t> corner;  ///< 3 a triangle of PatchMesh::pieces: its shading vertices
};
ShadingVertices shadingVertices(const PatchMesh& mesh, double crease);

/// The edges of all outlines as pairs of vertices, each once, the smaller vertex first.
std::vector<std::uint32_t> outlineEdges(const PatchMesh& mesh);

/// Adds position, patch_triangle, triangle_patch, triangle_corner, shading_* and edge. Positions
/// are less `origin`.
void addSurfaces(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container);

/// Three floats for each point, less `origin`.
std::vector<float> packed(std::span<const Vec3> points, const Vec3& origin = Vec3(0.0));

}  // namespace radiosity::page
