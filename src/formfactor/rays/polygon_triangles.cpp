#include "formfactor/rays/polygon_triangles.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <utility>

namespace radiosity {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Projection_traits_3<Kernel>;
constexpr int kUnvisited = -1;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Traits>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Traits,
                                              CGAL::Constrained_triangulation_face_base_2<Traits>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Traits, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;

/// Numbers every face with how many loops lie between it and the outside: odd ones are inside.
void markDepths(Triangulation& triangulation) {
  for (const auto& face : triangulation.all_face_handles()) face->info() = kUnvisited;
  std::vector<std::pair<Triangulation::Face_handle, int>> open = {
      {triangulation.infinite_face(), 0}};
  while (!open.empty()) {
    // Stay within one region as long as possible: regions one loop deeper wait at the front.
    std::vector<std::pair<Triangulation::Face_handle, int>> deeper;
    while (!open.empty()) {
      const auto [face, depth] = open.back();
      open.pop_back();
      if (face->info() != kUnvisited) continue;
      face->info() = depth;
      for (int k = 0; k < 3; ++k) {
        const auto neighbour = face->neighbor(k);
        if (neighbour->info() != kUnvisited) continue;
        if (triangulation.is_constrained({face, k})) {
          deeper.emplace_back(neighbour, depth + 1);
        } else {
          open.emplace_back(neighbour, depth);
        }
      }
    }
    open = std::move(deeper);
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> polygonTriangles(const ViewScene& scene, Index p) {
  const ViewPolygon& polygon = scene.polygons[p];
  const Traits traits(Kernel::Vector_3(polygon.normal.x, polygon.normal.y, polygon.normal.z));
  Triangulation triangulation(traits);
  for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
    std::vector<Triangulation::Vertex_handle> loop;
    for (std::uint32_t c = scene.loop_offset[l]; c < scene.loop_offset[l + 1]; ++c) {
      const Vec3& v = scene.vertices[scene.corners[c]];
      loop.push_back(triangulation.insert(Kernel::Point_3(v.x, v.y, v.z)));
      loop.back()->info() = scene.corners[c];
    }
    for (std::size_t k = 0; k < loop.size(); ++k) {
      triangulation.insert_constraint(loop[k], loop[(k + 1) % loop.size()]);
    }
  }
  markDepths(triangulation);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const auto& face : triangulation.finite_face_handles()) {
    if (face->info() % 2 != 1) continue;
    triangles.push_back(
        {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  }
  return triangles;
}

}  // namespace radiosity
