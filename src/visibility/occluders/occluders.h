// Occluders: convex solids and convex pieces of planar polygons.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "visibility/elements/elements.h"

namespace radiosity {

/// A convex body that blocks: a convex solid of the scene, or a flat convex polygon (a piece of
/// planar polygons that are no faces of such a solid), as a solid of thickness zero with two
/// opposite faces. Corners and planes in ElementSet's coordinates.
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
  /// Facets of the ElementSet that it hides nothing from: they lie on its planes (sides of its
  /// polygons), or near it and in front of all of it; sorted.
  std::vector<Index> facets;
};

/// Together the occluders block the same as the polygons, between any two points that elements see
/// each other from. A convex solid takes the place of polygons that lie on its surface only if
/// nothing of the scene is inside it and nothing can be seen through gaps in its surface (the
/// contact area under a box on a floor). Every other polygon is a flat occluder or several, its
/// convex pieces; coplanar neighbours are merged if that gives fewer pieces. A polygon that cannot
/// block anything (all of the scene lies on one side of its plane) has none.
struct OccluderSet {
  /// Takes n log n time. Throws Cancelled.
  OccluderSet(const PatchMesh& mesh, const ElementSet& elements, Progress& progress);
  OccluderSet(const PatchMesh& mesh, const ElementSet& elements);
  std::vector<Occluder> occluders;
  std::size_t solids = 0;        ///< occluders that are solids; they come first
  std::size_t skipped_hull = 0;  ///< polygons that cannot block: all of the scene is on one side
  /// Per facet: 1 if it sees nothing of the scene. It looks into a solid, or the whole scene is
  /// behind its plane.
  std::vector<std::uint8_t> hidden_facets;
};

}  // namespace radiosity
