// Convex solids from the polygons of a scene.
#pragma once

#include <cstdint>
#include <vector>

#include "visibility/occluders/occluders.h"
#include "visibility/occluders/polygons.h"

namespace radiosity {

struct ConvexSolid {
  Occluder body;
  /// Polygons that lie on faces of the body, whichever way they look, ascending, and those faces.
  struct OnFace {
    Index polygon;
    Index face;  ///< plane of the body
  };
  std::vector<OnFace> on_faces;
};

/// Finds sets of one-sided polygons in convex position (each lies behind all others' planes), grown
/// over common edges, whose convex hull blocks just what the scene's polygons block:
/// - no polygon enters the hull, so that nothing is inside to see or to be seen;
/// - if the set does not cover a face of the hull, nothing gets in: the whole scene is behind that
///   face (a box on the floor of a room, contact area dropped); or it is the only such face, so
///   that any way in has to come out elsewhere, and its surroundings are tied to it edge by edge or
///   cover it (a box on a table); or the polygons belong to a closed surface with the hull on the
///   side that nobody looks into (a book between books on a board);
/// - no polygons on its faces look into it and see each other, or out through an open face (the
///   inner sheet of a basin that is two sheets back to back).
/// If faces were cut at contacts or merged with others', so that such sets are small, slabs behind
/// single polygons stand in (slabs.h), those with most volume and area first.
/// A curved surface (ConvexGroups) is a solid if all of it is in convex position; parts of one that
/// is not are left to be flat. So all takes n log n time.
/// `taken[p]` becomes 1 for the polygons on the faces of the solids found.
std::vector<ConvexSolid> convexSolids(const OccluderPolygons& all, std::vector<std::uint8_t>& taken,
                                      Progress& progress);

}  // namespace radiosity
