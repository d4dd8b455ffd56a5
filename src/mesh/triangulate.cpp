#include "mesh/triangulate.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"
#include "mesh/edge_key.h"
#include "mesh/plane_image.h"

namespace radiosity {

namespace {

// Outlines with more corners than this are clipped ear by ear only if necessary.
constexpr std::size_t kManyCorners = 64;

using Triangles = std::vector<std::array<Index, 3>>;

double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross2(b - a, c - a); }

/// Whether corner `k` of the remaining outline can be cut off: it is convex, and no other corner is
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

/// Whether corner `k` lies in line with its neighbours, so that cutting it off removes no area.
bool isFlat(std::span<const Vec2> p, const std::vector<Index>& rest, std::size_t k) {
  const std::size_t n = rest.size();
  return turn(p[rest[(k + n - 1) % n]], p[rest[k]], p[rest[(k + 1) % n]]) == 0;
}

Triangles clipEars(std::span<const Vec2> outline) {
  Triangles triangles;
  const double sign = polygonArea(outline) < 0 ? -1.0 : 1.0;
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
    if (ear == n) ear = 0;  // the outline crosses itself, so any triangle will do
    triangles.push_back({rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]});
    rest.erase(rest.begin() + std::ptrdiff_t(ear));
    k = ear < rest.size() ? ear : 0;
  }
  triangles.push_back({rest[0], rest[1], rest[2]});
  return triangles;
}

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>;
/// The winding number of the loops around a triangle.
using WindingFaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using MarkedTriangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, WindingFaceBase>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;
constexpr int kUnknown = std::numeric_limits<int>::min();

/// Loops in the plane, with the corners of all loops in one array.
struct FlatLoops {
  std::vector<Vec2> corners;
  std::vector<std::size_t> ends;  ///< of each loop, into corners
};

class LoopTriangulation {
 public:
  explicit LoopTriangulation(const FlatLoops& loops) : loops_(loops) {}

  /// The triangles; empty if loops cross, or if a winding number is neither 0 nor `winding`.
  std::optional<Triangles> run(int winding) {
    insertCorners();
    if (!insertLoops()) return std::nullopt;
    if (cdt_.dimension() < 2) return Triangles();
    wind();
    Triangles out;
    for (const auto f : cdt_.finite_face_handles()) {
      if (f->info() == 0) continue;
      if (f->info() != winding) return std::nullopt;
      const Index b = f->vertex(winding < 0 ? 2 : 1)->info();
      const Index c = f->vertex(winding < 0 ? 1 : 2)->info();
      out.push_back({f->vertex(0)->info(), b, c});
    }
    return out;
  }

 private:
  /// Inserts corners; those in one place become one vertex with the number of the first.
  void insertCorners() {
    const std::vector<Vec2>& p = loops_.corners;
    std::vector<Index> order(p.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return std::tie(p[a].x, p[a].y, a) < std::tie(p[b].x, p[b].y, b);
    });
    std::vector<Index> first(p.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const bool repeats = k > 0 && p[order[k]] == p[order[k - 1]];
      first[order[k]] = repeats ? first[order[k - 1]] : order[k];
    }
    std::vector<std::pair<MarkedTriangulation::Point, Index>> points;
    points.reserve(p.size());
    for (Index k = 0; k < p.size(); ++k) {
      if (first[k] == k) points.emplace_back(MarkedTriangulation::Point(p[k].x, p[k].y), k);
    }
    cdt_.insert(points.begin(), points.end());
    vertices_.resize(p.size());
    for (const auto v : cdt_.finite_vertex_handles()) vertices_[v->info()] = v;
    for (Index k = 0; k < p.size(); ++k) vertices_[k] = vertices_[first[k]];
  }

  /// Inserts the loops as constraints; false if they cross.
  bool insertLoops() {
    std::size_t begin = 0;
    for (const std::size_t end : loops_.ends) {
      for (std::size_t k = begin; k < end; ++k) {
        const auto a = vertices_[k];
        const auto b = vertices_[k + 1 < end ? k + 1 : begin];
        if (a == b) continue;
        try {
          cdt_.insert_constraint(a, b);
        } catch (const MarkedTriangulation::Intersection_of_constraints_exception&) {
          return false;
        }
        countAlong(a, b);
      }
      begin = end;
    }
    return true;
  }

  /// Counts the loops along the edges of a b, on which other corners may lie.
  void countAlong(MarkedTriangulation::Vertex_handle a, MarkedTriangulation::Vertex_handle b) {
    while (a != b) {
      MarkedTriangulation::Vertex_handle next;
      MarkedTriangulation::Face_handle face;
      int side = 0;
      cdt_.includes_edge(a, b, next, face, side);
      ++along_[directedKey(a->info(), next->info())];
      --along_[directedKey(next->info(), a->info())];
      a = next;
    }
  }

  /// Finds the winding number of every triangle. It starts outside, where it is 0; across an edge
  /// it changes by the number of loops that run along the edge.
  void wind() {
    for (const auto f : cdt_.all_face_handles()) f->info() = kUnknown;
    std::vector<MarkedTriangulation::Face_handle> open{cdt_.infinite_face()};
    cdt_.infinite_face()->info() = 0;
    while (!open.empty()) {
      const auto f = open.back();
      open.pop_back();
      for (int i = 0; i < 3; ++i) {
        const auto next = f->neighbor(i);
        if (next->info() != kUnknown) continue;
        next->info() = f->info();
        if (f->is_constrained(i)) {
          next->info() -= along_.at(directedKey(f->vertex(MarkedTriangulation::ccw(i))->info(),
                                                f->vertex(MarkedTriangulation::cw(i))->info()));
        }
        open.push_back(next);
      }
    }
  }

  const FlatLoops& loops_;
  MarkedTriangulation cdt_;
  std::vector<MarkedTriangulation::Vertex_handle> vertices_;  ///< of the corners
  std::unordered_map<std::uint64_t, int> along_;  ///< loops along a directed edge, less those back
};

/// Cuts a quadrilateral along the shorter of its inner diagonals; empty if neither is inside.
std::optional<Triangles> halves(std::span<const Index> loop, const std::array<Vec2, 4>& p) {
  const bool first = turn(p[0], p[1], p[2]) > 0 && turn(p[0], p[2], p[3]) > 0;
  const bool second = turn(p[0], p[1], p[3]) > 0 && turn(p[1], p[2], p[3]) > 0;
  if (!first && !second) return std::nullopt;
  const bool shorter = glm::length(p[2] - p[0]) <= glm::length(p[3] - p[1]);
  if (first && (shorter || !second)) {
    return Triangles{{loop[0], loop[1], loop[2]}, {loop[0], loop[2], loop[3]}};
  }
  return Triangles{{loop[0], loop[1], loop[3]}, {loop[1], loop[2], loop[3]}};
}

}  // namespace

std::optional<Triangles> triangulatePolygon(std::span<const Vec3> vertices,
                                            std::span<const std::span<const Index>> loops,
                                            const Vec3& normal) {
  const PlaneImage image(normal);
  const auto at = [&](Index v) { return image(vertices[v]); };
  if (loops.size() == 1 && loops[0].size() == 3) {
    const auto l = loops[0];
    if (turn(at(l[0]), at(l[1]), at(l[2])) > 0) return Triangles{{l[0], l[1], l[2]}};
  }
  if (loops.size() == 1 && loops[0].size() == 4) {
    const auto l = loops[0];
    if (auto two = halves(l, {at(l[0]), at(l[1]), at(l[2]), at(l[3])})) return two;
  }
  FlatLoops flat;
  std::vector<Index> vertex;
  for (const std::span<const Index> loop : loops) {
    for (const Index v : loop) flat.corners.push_back(at(v));
    vertex.insert(vertex.end(), loop.begin(), loop.end());
    flat.ends.push_back(vertex.size());
  }
  std::optional<Triangles> triangles = LoopTriangulation(flat).run(1);
  if (!triangles) return triangles;
  for (std::array<Index, 3>& t : *triangles) t = {vertex[t[0]], vertex[t[1]], vertex[t[2]]};
  return triangles;
}

std::optional<Triangles> delaunayTriangles(std::span<const Vec2> outline) {
  const FlatLoops loops{{outline.begin(), outline.end()}, {outline.size()}};
  return LoopTriangulation(loops).run(polygonArea(outline) < 0 ? -1 : 1);
}

std::vector<std::array<Index, 3>> triangulateOutline(std::span<const Vec2> outline) {
  if (outline.size() < 3) return {};
  if (outline.size() > kManyCorners) {
    if (auto triangles = delaunayTriangles(outline)) return *triangles;
  }
  return clipEars(outline);
}

}  // namespace radiosity
