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
/// Nothing if loops cross, overlap or turn the wrong way. n log n in the corners (constrained
/// Delaunay); a triangle or a simple quadrilateral only takes a few products.
std::optional<std::vector<std::array<Index, 3>>> triangulatePolygon(
    std::span<const Vec3> vertices, std::span<const std::span<const Index>> loops,
    const Vec3& normal);

/// The same for one loop in the plane that turns either way, and so do the triangles. Nothing if it
/// crosses itself.
std::optional<std::vector<std::array<Index, 3>>> delaunayTriangles(std::span<const Vec2> outline);

/// Triangles that tile a simple polygon in the plane (counter-clockwise or clockwise; they turn
/// the same way): n - 2 of them. Collinear and repeated corners are allowed and may give triangles
/// without area. Few corners are clipped as ears, many are triangulated by delaunayTriangles(). An
/// outline that crosses itself gets n - 2 triangles, too, whose signed areas sum to its own.
std::vector<std::array<Index, 3>> triangulateOutline(std::span<const Vec2> outline);

}  // namespace radiosity
