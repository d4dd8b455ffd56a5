// Triangles over the corners of planar polygons, without added points.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Triangles that tile a planar polygon: triples of its own vertices, each triangle with an area
/// and counter-clockwise about `normal`. No points are added. `loops` index `vertices`: outer loops
/// counter-clockwise about the normal, holes clockwise; they may touch each other and themselves.
/// Empty if loops cross, overlap or turn the wrong way. O(n log n) in the corners (constrained
/// Delaunay); a triangle or a simple quadrilateral only takes a few products.
std::optional<std::vector<std::array<Index, 3>>> triangulatePolygon(
    std::span<const Vec3> vertices, std::span<const std::span<const Index>> loops,
    const Vec3& normal);

/// The same for one loop in the plane that may turn either way; the triangles turn the same way.
/// Empty if it crosses itself.
std::optional<std::vector<std::array<Index, 3>>> delaunayTriangles(std::span<const Vec2> outline);

/// The n - 2 triangles that tile a simple polygon in the plane (counter-clockwise or clockwise; the
/// triangles turn the same way). Collinear and repeated corners are allowed and may give triangles
/// without area. Outlines with few corners are clipped ear by ear, others are triangulated by
/// delaunayTriangles(). An outline that crosses itself also gets n - 2 triangles, whose signed
/// areas sum to its own.
std::vector<std::array<Index, 3>> triangulateOutline(std::span<const Vec2> outline);

}  // namespace radiosity
