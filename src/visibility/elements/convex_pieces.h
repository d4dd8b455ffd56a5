// Polygons with holes cut into convex pieces.
#pragma once

#include <vector>

#include "base/geometry/plane_frame.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The loops of a planar polygon of a mesh, corner by corner: (vertex - middle) * scale.
std::vector<std::vector<Vec3>> polygonLoops(const PatchMesh& mesh, std::size_t polygon,
                                            const Vec3& middle, double scale);

/// The frame of a polygon's plane: u along its longest edge (of equals the first), so that the
/// frame turns with the polygon and grids of rectangles lie along its axes. The origin is a corner.
PlaneFrame polygonFrame(const std::vector<std::vector<Vec3>>& loops, const Vec3& normal);

/// The trapezoids and triangles with sides along u that tile a region bounded by loops (its inside
/// is even-odd, so holes and several outer loops need no care), each counter-clockwise. Corners
/// whose v differ by no more than `coincidence` count as level. Pieces meet in T-junctions: they
/// serve for areas and for blocking, not for meshing. About two pieces a corner at most; O(n^2) at
/// worst.
std::vector<std::vector<Vec2>> convexPieces(const std::vector<std::vector<Vec2>>& loops,
                                            double coincidence);

/// The same for a polygon in space, counter-clockwise about `normal`.
std::vector<std::vector<Vec3>> convexPieces(const std::vector<std::vector<Vec3>>& loops,
                                            const Vec3& normal, double coincidence);

}  // namespace radiosity
