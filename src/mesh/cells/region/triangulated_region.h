// A region's pieces and points inside, triangulated (CGAL's constrained Delaunay triangulation).
#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <array>
#include <cstdint>
#include <unordered_set>
#include <vector>

#include "mesh/cells/region/region.h"
#include "mesh/edge_key.h"

namespace radiosity {

using RegionKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
/// A vertex has its place among the region's points and the inner ones; a face knows whether it is
/// inside.
using RegionTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    RegionKernel,
    CGAL::Triangulation_data_structure_2<
        CGAL::Triangulation_vertex_base_with_info_2<Index, RegionKernel>,
        CGAL::Triangulation_face_base_with_info_2<
            bool, RegionKernel, CGAL::Constrained_triangulation_face_base_2<RegionKernel>>>,
    CGAL::No_constraint_intersection_tag>;
using RegionFace = RegionTriangulation::Face_handle;
using RegionVertex = RegionTriangulation::Vertex_handle;

inline Vec2 positionOf(RegionVertex v) { return {v->point().x(), v->point().y()}; }
inline RegionTriangulation::Point pointOf(const Vec2& p) { return {p.x, p.y}; }

class TriangulatedRegion {
 public:
  /// Has the points of a background grid inside. `region` must outlive it.
  explicit TriangulatedRegion(const Region& region);

  /// Whether the region is a triangle without inner points. It is its own triangulation: all its
  /// angles are given, and none of its edges may be cut or flipped. Its first corner is that of the
  /// triangulation of three points.
  bool isPlainTriangle() const;

  /// Triangulates anew. False if pieces cross, which inner points cannot change.
  bool triangulate();

  /// Whether the triangles inside have the area of the loops. They have not if loops touch, or if
  /// rounding has turned a triangle over.
  bool tiles() const;

  /// Adds a point inside the face `where`.
  RegionVertex insert(const RegionTriangulation::Point& p, RegionFace where);

  /// Keeps the places that vertices inside have been moved to, for the next triangulate().
  void takePositions();

  /// The triangles inside.
  std::vector<std::array<Index, 3>> triangles() const;

  /// Whether a vertex is no end of a piece, so that it may be moved.
  bool isFree(RegionVertex v) const { return v->info() >= region_.points.size(); }

  const Region& region() const { return region_; }
  const std::vector<Vec2>& interior() const { return interior_; }
  RegionTriangulation& cdt() { return cdt_; }
  const RegionTriangulation& cdt() const { return cdt_; }

 private:
  bool insertPieces(const std::vector<RegionVertex>& vertices);
  void markInside();
  bool isOutline(RegionFace f, int i) const {
    return f->is_constrained(i) &&
           outline_.count(edgeKey(f->vertex(RegionTriangulation::cw(i))->info(),
                                  f->vertex(RegionTriangulation::ccw(i))->info())) > 0;
  }

  const Region& region_;
  std::unordered_set<std::uint64_t> outline_;
  std::vector<Vec2> interior_;
  RegionTriangulation cdt_;
};

}  // namespace radiosity
