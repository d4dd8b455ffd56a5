// What of a mesh a page draws: triangles, what each of their corners shows, and outlines.
#pragma once

#include <vector>

#include "page/container.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"

namespace radiosity::page {

/// What smooth shading mixes: a shading vertex shows the mean of some patches by area, as
/// cornerValues() does.
struct ShadingVertices {
  std::vector<std::uint32_t> begin;  ///< S + 1, into the others
  std::vector<std::uint32_t> patch;
  std::vector<float> weight;          ///< sum to 1 in each vertex
  std::vector<std::uint32_t> corner;  ///< 3 a triangle of PatchMesh::pieces: its shading vertices
};
ShadingVertices shadingVertices(const PatchMesh& mesh, double crease);

/// Pairs of vertices, each once: edges of all outlines, the smaller vertex first.
std::vector<std::uint32_t> outlineEdges(const PatchMesh& mesh);

/// position, patch_triangle, triangle_patch, triangle_corner, shading_*, edge. Positions are less
/// `origin`.
void addSurfaces(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container);

/// element_*: the lit mesh of elements, as writeLitGlb() has it. Returns how many triangles; 0 and
/// empty arrays where `light` has no elements.
std::size_t addElements(const PatchMesh& mesh, const SurfaceLight& light, double crease,
                        const Vec3& origin, Container& container);

/// Three floats a point, less `origin`.
std::vector<float> packed(std::span<const Vec3> points, const Vec3& origin = Vec3(0.0));

}  // namespace radiosity::page
