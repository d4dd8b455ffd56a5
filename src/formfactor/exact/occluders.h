// What can stand between two elements: convex solids and convex pieces of planar polygons.
#pragma once

#include <array>
#include <vector>

#include "formfactor/exact/elements.h"
#include "radiosity/base.h"

namespace radiosity {

/// A convex body that blocks: a closed convex solid of the scene, or a flat convex polygon (a
/// piece of a planar polygon that is no face of such a solid), as a solid of thickness zero with
/// two opposite faces. Corners and planes in ElementSet's coordinates.
struct Occluder {
  struct Plane {
    Vec3 normal{0.0};   ///< unit, outward
    double offset = 0;  ///< dot(normal, x) <= offset inside
  };
  /// corners[from] -> corners[to] runs counter-clockwise about `left`'s normal.
  struct Edge {
    Index from, to;
    Index left, right;  ///< planes
  };
  std::vector<Vec3> corners;
  std::vector<Plane> planes;
  std::vector<Edge> edges;
  Vec3 centre{0.0};  ///< bounding sphere
  double radius = 0;
  bool flat = false;
  std::vector<Index>
      facets;  ///< facets of the ElementSet that lie on its planes (sides of its polygons)
};

/// Every polygon of the mesh is part of exactly one occluder (a solid) or of as many flat ones as
/// it has convex pieces. A polygon that cannot block anything (all of the scene lies on one side
/// of its plane) has none.
struct OccluderSet {
  OccluderSet(const PatchMesh& mesh, const ElementSet& elements);
  std::vector<Occluder> occluders;
  std::size_t solids = 0;        ///< occluders that are solids; they come first
  std::size_t skipped_hull = 0;  ///< polygons that cannot block: all of the scene is on one side
};

}  // namespace radiosity
