// The coarse complex: the output of the contact stage and the input of the subdivision stage.
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
  bool front = true;  ///< the front carries patches (always, since a lone back is turned over)
  bool back = false;  ///< the back carries patches
  /// The polygon on the same area that faces the other way (a plate without thickness), or kNone.
  /// It has the same loops, reversed, and the same inner edges.
  Index opposite = kNone;
  double coincidence = 0;  ///< metres, the least of its vertices'; 0: the complex's
  /// Faces of the scene from which this polygon was merged (for source_face and textures).
  std::vector<Index> faces;
};

/// Planar polygons that meet vertex for vertex: no vertex lies inside an edge (closer than
/// `coincidence`) of any loop or inner edge, and no two polygons cross or overlap (two that
/// coincide whole, back to back, name each other as `opposite`).
struct CoarseComplex {
  std::vector<Vec3> vertices;  ///< recentred on `origin`
  Vec3 origin{0.0};            ///< add it to a vertex to get the place in the scene
  double coincidence = 0;      ///< metres: the one length tolerance, but of small things
  std::vector<CoarsePolygon> polygons;

  double coincidenceOf(const CoarsePolygon& polygon) const {
    return polygon.coincidence > 0 ? polygon.coincidence : coincidence;
  }
};

/// Welds and merges faces, cuts them at contacts, and drops buried parts. Fills the report's repair
/// figures and the surfaces' areas except `kept`.
CoarseComplex buildComplex(const Scene& scene, const MeshOptions& options, MeshReport& report,
                           Progress& progress);

/// Cuts a complex into triangles and convex quadrilaterals, conforming across polygons. If there
/// are more than the options ask for, joins cells of a polygon. Fills the report's patch figures
/// and `kept`.
PatchMesh subdivide(const CoarseComplex& complex, const Scene& scene, const MeshOptions& options,
                    MeshReport& report, Progress& progress);

/// --faces-as-patches: patch k is face k of the file. Throws Cancelled.
PatchMesh facesAsPatches(const Scene& scene, const MeshOptions& options, MeshReport& report,
                         Progress& progress);

}  // namespace radiosity
