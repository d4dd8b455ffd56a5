// The planar polygons of a mesh as the search for occluders needs them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "base/geometry/box_tree.h"
#include "base/geometry/point_tree.h"
#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"
#include "visibility/elements/elements.h"

namespace radiosity {

struct OccluderPolygon {
  Index source = 0;  ///< of the mesh
  /// Into OccluderPolygons::vertices; outer loops counter-clockwise about the normal, holes
  /// clockwise.
  std::vector<std::vector<Index>> loops;
  std::vector<Index> corners;  ///< of its convex hull: enough to test it against a half-space
  Vec3 normal{0.0};
  double offset = 0;          ///< dot(normal, x) of its plane
  double area = 0;            ///< scaled
  double deviation = 0;       ///< largest distance of a vertex from the plane
  bool planar = true;         ///< within coincidence
  bool convex = false;        ///< one loop that turns one way
  bool one_sided = true;      ///< its back carries no patches
  bool bounds_scene = false;  ///< all of the scene lies on one side of its plane
  bool faces_scene = false;   ///< namely in front of it: there is nothing behind
  Box3 box;
};

/// A directed edge between vertices.
using OccluderEdge = std::pair<Index, Index>;
/// Polygons that run along each directed edge.
using OccluderEdgeUsers = std::map<OccluderEdge, std::vector<Index>>;

/// Vertices closer than the coincidence are one (files may give each face its own). Polygons are
/// ordered by surface name and index within the surface, so that nothing depends on numbering.
struct OccluderPolygons {
  OccluderPolygons(const PatchMesh& mesh, const ElementSet& elements);

  std::vector<Vec3> vertices;  ///< in ElementSet's coordinates
  std::vector<OccluderPolygon> polygons;
  double coincidence = 0;
  BoxTree tree;           ///< of the polygons' boxes
  PointTree vertex_tree;  ///< of the scene's vertices

  /// True if no vertex of the scene lies in front of a plane, farther than `margin`.
  bool allBehind(const Vec3& normal, double offset, double margin) const {
    return !vertex_tree.anyAbove(normal, offset + margin);
  }

  OccluderEdgeUsers edgeUsers() const;

  /// Triangles over the polygon's own vertices that tile it, counter-clockwise about its normal.
  /// None if its loops cross.
  std::vector<std::array<Index, 3>> trianglesOf(const OccluderPolygon& polygon) const;

 private:
  void addPolygon(const PatchMesh& mesh, const ElementSet& elements, Index p,
                  const std::vector<Index>& place);
  void describe(OccluderPolygon& polygon) const;
  void findBounding();
};

}  // namespace radiosity
