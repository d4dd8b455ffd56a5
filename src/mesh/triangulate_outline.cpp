#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <numeric>
#include <optional>

#include "mesh/face_locator.h"

namespace radiosity {

namespace {

// Outlines with more corners are not clipped ear by ear if they need not be.
constexpr std::size_t kManyCorners = 64;

using Triangles = std::vector<std::array<Index, 3>>;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross2(b - a, c - a); }

/// Whether the corner `k` of the remaining outline can be cut off: convex, and no other corner
/// inside or on the triangle (repeats of its own corners do not count).
bool isEar(std::span<const Vec2> p, const std::vector<Index>& rest, std::size_t k, double sign) {
  const std::size_t n = rest.size();
  const Vec2& a = p[rest[(k + n - 1) % n]];
  const Vec2& b = p[rest[k]];
  const Vec2& c = p[rest[(k + 1) % n]];
  if (!(sign * turn(a, b, c) > 0)) return false;
  for (const Index i : rest) {
    const Vec2& q = p[i];
    if (q == a || q == b || q == c) continue;
    if (sign * turn(a, b, q) >= 0 && sign * turn(b, c, q) >= 0 && sign * turn(c, a, q) >= 0) {
      return false;
    }
  }
  return true;
}

/// Whether the corner `k` lies in line with its neighbours: cutting it off takes no area away.
bool isFlat(std::span<const Vec2> p, const std::vector<Index>& rest, std::size_t k) {
  const std::size_t n = rest.size();
  return turn(p[rest[(k + n - 1) % n]], p[rest[k]], p[rest[(k + 1) % n]]) == 0;
}

/// Twice the signed area.
double doubledArea(std::span<const Vec2> outline) {
  double area = 0;
  for (std::size_t k = 2; k < outline.size(); ++k) {
    area += turn(outline[0], outline[k - 1], outline[k]);
  }
  return area;
}

Triangles clipEars(std::span<const Vec2> outline) {
  Triangles triangles;
  const double sign = doubledArea(outline) < 0 ? -1.0 : 1.0;
  std::vector<Index> rest(outline.size());
  std::iota(rest.begin(), rest.end(), 0u);
  std::size_t k = 0;
  while (rest.size() > 3) {
    const std::size_t n = rest.size();
    std::size_t ear = n;
    for (std::size_t tried = 0; tried < n && ear == n; ++tried) {
      if (isEar(outline, rest, (k + tried) % n, sign)) ear = (k + tried) % n;
    }
    for (std::size_t flat = 0; flat < n && ear == n; ++flat) {
      if (isFlat(outline, rest, flat)) ear = flat;
    }
    if (ear == n) ear = 0;  // the outline crosses itself: any triangle is as good as another
    triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + std::ptrdiff_t(ear));
    k = ear < rest.size() ? ear : 0;
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
/// Whether a triangle lies inside the outline.
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<bool, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;

/// False if corners coincide or edges touch.
bool insertOutline(std::span<const Vec2> outline, Cdt& cdt) {
  std::vector<std::pair<Cdt::Point, Index>> points;
  points.reserve(outline.size());
  for (std::size_t k = 0; k < outline.size(); ++k) {
    points.emplace_back(Cdt::Point(outline[k].x, outline[k].y), Index(k));
  }
  cdt.insert(points.begin(), points.end());
  if (cdt.number_of_vertices() != outline.size()) return false;
  std::vector<Cdt::Vertex_handle> handles(outline.size());
  for (const auto v : cdt.finite_vertex_handles()) handles[v->info()] = v;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto a = handles[k];
    const auto b = handles[(k + 1) % outline.size()];
    try {
      cdt.insert_constraint(a, b);
    } catch (const Cdt::Intersection_of_constraints_exception&) {
      return false;
    }
    if (!cdt.is_edge(a, b)) return false;
  }
  return true;
}

/// What cannot be reached from outside without crossing the outline is inside.
void markInside(Cdt& cdt) {
  for (const auto f : cdt.all_face_handles()) f->info() = true;
  std::vector<Cdt::Face_handle> outside{cdt.infinite_face()};
  cdt.infinite_face()->info() = false;
  while (!outside.empty()) {
    const auto f = outside.back();
    outside.pop_back();
    for (int i = 0; i < 3; ++i) {
      const auto next = f->neighbor(i);
      if (f->is_constrained(i) || !next->info()) continue;
      next->info() = false;
      outside.push_back(next);
    }
  }
}

}  // namespace

std::optional<Triangles> delaunayTriangles(std::span<const Vec2> outline) {
  Cdt cdt;
  if (!insertOutline(outline, cdt)) return std::nullopt;
  markInside(cdt);
  const bool clockwise = doubledArea(outline) < 0;
  Triangles out;
  for (const auto f : cdt.finite_face_handles()) {
    if (!f->info()) continue;
    const Index b = f->vertex(clockwise ? 2 : 1)->info();
    const Index c = f->vertex(clockwise ? 1 : 2)->info();
    out.push_back({f->vertex(0)->info(), b, c});
  }
  return out;
}

std::vector<std::array<Index, 3>> triangulateOutline(std::span<const Vec2> outline) {
  if (outline.size() < 3) return {};
  if (outline.size() > kManyCorners) {
    if (auto triangles = delaunayTriangles(outline)) return *triangles;
  }
  return clipEars(outline);
}

}  // namespace radiosity
