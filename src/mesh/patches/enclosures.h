// Tests of points and polygons against closed surfaces of a mesh (findEnclosures(), patch_mesh.h).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The coincidence of a mesh, metres: its own or, if it has none, the default share of its
/// diagonal.
double coincidenceOf(const PatchMesh& mesh);

/// For every vertex the first one at exactly the same point (faces_as_patches gives each face its
/// own vertices).
std::vector<Index> firstAtSamePoint(const PatchMesh& mesh);

/// The mesh's own enclosures; if it has none, finds them and keeps them in `found`.
const Enclosures& enclosuresOf(const PatchMesh& mesh, std::optional<Enclosures>& found);

/// The winding number of polygons about a point: 1 inside an outward solid, -1 inside a room, 0
/// outside of both. It is the sum of signed solid angles over 4 pi, not an integer on a polygon.
double windingNumber(const PatchMesh& mesh, std::span<const Index> polygons, const Vec3& point);

/// Whether a point lies on the side that the fronts of a closed surface face. On the surface:
/// false.
bool isOnFrontSide(const PatchMesh& mesh, const ClosedSurface& surface, const Vec3& point);

/// True if no two of the polygons cross or touch, except at points that are corners of both
/// (`first`: from firstAtSamePoint()). Doubtful cases, closer than `coincidence`, count as
/// touching.
bool isEmbedded(const PatchMesh& mesh, std::span<const Index> first,
                std::span<const Index> polygons, double coincidence);

/// For every polygon the first one on the same corners.
std::vector<Index> firstOnSameCorners(const PlanarPolygons& polygons, std::span<const Index> first);

/// For every patch 1 if it is proved to see no sky, since it looks into a bounded space; also for
/// one without an area. Throws Cancelled.
std::vector<std::uint8_t> enclosedPatches(const PatchMesh& mesh, std::span<const Index> first,
                                          double coincidence, Progress& progress);

}  // namespace radiosity
