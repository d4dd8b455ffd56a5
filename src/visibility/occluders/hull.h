// Convex hulls whose faces are the planes of the polygons they were made from.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "visibility/occluders/occluders.h"

namespace radiosity {

/// A polygon's convex hull in its plane, counter-clockwise about `normal`, as positions in
/// `points`; corners closer than `coincidence` to the line through their neighbours are left out.
std::vector<Index> planarHull(std::span<const Vec3> points, std::span<const Index> members,
                              const Vec3& normal, double coincidence);

/// The hull of points that lie on or below all of `planes`. Every plane becomes a face; other faces
/// are found by wrapping (Chand & Kapur 1970): about an edge that has one face, the plane through
/// it that leaves all points on one side. Points within `coincidence` of a plane lie on it. None if
/// faces do not close up into a solid, or meet at an edge as sharp as a knife.
std::optional<Occluder> convexHull(const std::vector<Vec3>& points,
                                   const std::vector<Occluder::Plane>& planes, double coincidence);

/// Sets the bounding sphere: centre of the box, farthest corner.
void boundOccluder(Occluder& occluder);

double volumeOf(const Occluder& occluder);

}  // namespace radiosity
