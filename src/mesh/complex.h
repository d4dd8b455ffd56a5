// The coarse complex: what the contact stage hands to the subdivision stage.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// One planar polygon of the complex: connected, of one surface, all facing alike.
struct CoarsePolygon {
  /// Loops of vertices: first the outer one, counter-clockwise about `normal`, then the holes,
  /// clockwise. A loop visits no vertex twice; two loops may touch at a vertex.
  std::vector<std::vector<Index>> loops;
  /// Edges inside the polygon that the patches must respect: contact lines of other polygons.
  std::vector<std::array<Index, 2>> inner_edges;
  Vec3 normal{0.0};
  Index surface = kNone;
  bool front = true;  ///< the front carries patches (always: a lone back is turned over)
  bool back = false;  ///< the back carries patches
  /// Polygon on the same area that faces the other way (a plate without thickness), or kNone. Its
  /// loops are these reversed, its inner edges are these.
  Index opposite = kNone;
  /// Faces of the scene this polygon was merged from (for source_face and textures).
  std::vector<Index> faces;
};

/// Planar polygons that meet vertex for vertex: no vertex lies inside an edge (closer than
/// `coincidence`) of any loop or inner edge, and no two polygons cross or overlap (two that
/// coincide whole, back to back, name each other as `opposite`).
struct CoarseComplex {
  std::vector<Vec3> vertices;  ///< recentred on `origin`
  Vec3 origin{0.0};            ///< add to a vertex to be back in the scene
  double coincidence = 0;      ///< metres: the one length tolerance
  std::vector<CoarsePolygon> polygons;
};

/// Weld, merge, cut at contacts, drop what is buried. Fills the report's repair figures and the
/// surfaces' areas except `kept`.
CoarseComplex buildComplex(const Scene& scene, const MeshOptions& options, MeshReport& report,
                           Progress& progress);

/// Cuts a complex into triangles and convex quads, conforming across polygons; where those are more
/// than the options ask for, cells of a polygon are joined. Fills the report's patch figures and
/// `kept`.
PatchMesh subdivide(const CoarseComplex& complex, const Scene& scene, const MeshOptions& options,
                    MeshReport& report, Progress& progress);

/// --faces-as-patches: patch k is face k of the file.
PatchMesh facesAsPatches(const Scene& scene, const MeshOptions& options, MeshReport& report);

}  // namespace radiosity
