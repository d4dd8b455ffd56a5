// Convex pieces of planar polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

/// A convex piece of one or more coplanar polygons.
struct FlatPiece {
  std::vector<Index> loop;      ///< vertices, counter-clockwise about the normal; convex
  Vec3 normal{0.0};             ///< unit, of one of the two sides
  std::vector<Index> polygons;  ///< of which it is a piece
};

/// Cuts the polygons not marked in `taken` into convex pieces, as few as a greedy search finds.
/// Coplanar polygons that share edges (of any surface, facing either way) are put together, concave
/// ones are triangulated, and pieces are joined across the longest common border first as long as
/// they stay convex (Hertel & Mehlhorn 1983: at most four times the fewest).
/// A polygon whose loops cross, so that it has no triangulation, is cut into trapezoids, whose
/// corners become vertices of `all`.
std::vector<FlatPiece> flatPieces(OccluderPolygons& all, const std::vector<std::uint8_t>& taken,
                                  Progress& progress);

/// Makes a piece a solid without thickness. False if it is thinner than the coincidence.
bool makeFlatOccluder(const OccluderPolygons& all, const FlatPiece& piece, Occluder& occluder);

}  // namespace radiosity
