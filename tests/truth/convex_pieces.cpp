#include "convex_pieces.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Projection_traits_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>

#include <algorithm>
#include <optional>

namespace radiosity::truth {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Traits = CGAL::Projection_traits_3<Kernel>;
using Corners = std::vector<Vec3>;
constexpr std::size_t kMostCorners = 12;
/// Sine of a turn below which a corner is in line with its neighbours: what rounding of
/// coordinates makes of a straight line.
constexpr double kStraight = 1e-12;

/// Sine of the turn at b, positive to the left about `normal`.
double turn(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& normal) {
  const Vec3 in = b - a;
  const Vec3 out = c - b;
  const double lengths = glm::length(in) * glm::length(out);
  return lengths > 0 ? glm::dot(glm::cross(in, out), normal) / lengths : 0;
}

Corners withoutStraightCorners(Corners loop, const Vec3& normal) {
  for (std::size_t k = 0; loop.size() > 3 && k < loop.size();) {
    const std::size_t n = loop.size();
    const Vec3& a = loop[(k + n - 1) % n];
    const Vec3& c = loop[(k + 1) % n];
    const bool spike = glm::dot(loop[k] - a, c - loop[k]) < 0;
    if (std::abs(turn(a, loop[k], c, normal)) < kStraight && !spike) {
      loop.erase(loop.begin() + std::ptrdiff_t(k));
      k = k > 0 ? k - 1 : 0;
    } else {
      ++k;
    }
  }
  return loop;
}

bool isConvex(const Corners& loop, const Vec3& normal) {
  const std::size_t n = loop.size();
  if (n > kMostCorners) return false;
  double turned = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& a = loop[k];
    const Vec3& b = loop[(k + 1) % n];
    const Vec3& c = loop[(k + 2) % n];
    const double sine = turn(a, b, c, normal);
    if (!(sine > 0)) return false;
    turned += std::atan2(sine, glm::dot(b - a, c - b) / (glm::length(b - a) * glm::length(c - b)));
  }
  return turned < 7;  // once round, 2 pi, not twice
}

std::vector<Corners> triangles(const std::vector<Corners>& loops, const Vec3& normal) {
  using VertexBase = CGAL::Triangulation_vertex_base_2<Traits>;
  using FaceBase = CGAL::Triangulation_face_base_with_info_2<
      int, Traits, CGAL::Constrained_triangulation_face_base_2<Traits>>;
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
      Traits, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
  Triangulation made(Traits(Kernel::Vector_3(normal.x, normal.y, normal.z)));
  for (const Corners& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& a = loop[k];
      const Vec3& b = loop[(k + 1) % loop.size()];
      made.insert_constraint(Kernel::Point_3(a.x, a.y, a.z), Kernel::Point_3(b.x, b.y, b.z));
    }
  }
  // Depth of each face by flooding: crossing an edge of a loop changes inside and outside.
  constexpr int kUnseen = -1;
  for (const auto& face : made.all_face_handles()) face->info() = kUnseen;
  std::vector<std::pair<Triangulation::Face_handle, int>> open = {{made.infinite_face(), 0}};
  while (!open.empty()) {
    const auto [face, side] = open.back();
    open.pop_back();
    if (face->info() != kUnseen) continue;
    face->info() = side;
    for (int k = 0; k < 3; ++k) {
      open.emplace_back(face->neighbor(k), made.is_constrained({face, k}) ? 1 - side : side);
    }
  }
  std::vector<Corners> out;
  for (const auto& face : made.finite_face_handles()) {
    if (face->info() != 1) continue;
    Corners triangle;
    for (int k = 0; k < 3; ++k) {
      const auto& p = face->vertex(k)->point();
      triangle.emplace_back(p.x(), p.y(), p.z());
    }
    out.push_back(triangle);
  }
  return out;
}

/// Two loops joined over an edge they share, if the result is convex.
std::optional<Corners> joined(const Corners& a, const Corners& b, const Vec3& normal) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (a[i] != b[(j + 1) % b.size()] || a[(i + 1) % a.size()] != b[j]) continue;
      Corners loop;
      for (std::size_t k = 1; k <= a.size(); ++k) loop.push_back(a[(i + k) % a.size()]);
      for (std::size_t k = 2; k < b.size(); ++k) loop.push_back(b[(j + k) % b.size()]);
      loop = withoutStraightCorners(loop, normal);
      if (isConvex(loop, normal)) return loop;
      return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Joins neighbours until no two fit together.
std::vector<Corners> joinedAll(std::vector<Corners> pieces, const Vec3& normal) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size();) {
      if (const auto both = joined(pieces[i], pieces[j], normal)) {
        pieces[i] = *both;
        pieces.erase(pieces.begin() + std::ptrdiff_t(j));
        j = i + 1;
      } else {
        ++j;
      }
    }
  }
  return pieces;
}

}  // namespace

std::vector<Loop> convexPieces(const PlanarPolygons& polygons, std::size_t p,
                               const std::vector<Vec3>& vertices) {
  const Vec3& normal = polygons.normal[p];
  std::vector<Corners> loops;
  for (std::size_t l = polygons.loopBegin(p); l < polygons.loopEnd(p); ++l) {
    Corners loop;
    for (const Index v : polygons.loop(l)) loop.push_back(vertices[v]);
    loops.push_back(withoutStraightCorners(loop, normal));
  }
  std::vector<Corners> pieces = loops;
  if (loops.size() != 1 || !isConvex(loops[0], normal)) {
    pieces = joinedAll(triangles(loops, normal), normal);
  }
  std::vector<Loop> out;
  out.reserve(pieces.size());
  for (const Corners& piece : pieces) out.emplace_back(std::span<const Vec3>(piece));
  return out;
}

}  // namespace radiosity::truth
