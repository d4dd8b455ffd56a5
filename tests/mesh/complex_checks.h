// Invariants of every coarse complex, checked by brute force from its vertices and loops alone.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <vector>

#include "mesh/polygons/complex.h"

namespace radiosity::test {

struct Built {
  CoarseComplex complex;
  MeshReport report;
};

inline Built build(const Scene& scene, const MeshOptions& options = {}) {
  Built out;
  Progress progress;
  out.complex = buildComplex(scene, options, out.report, progress);
  return out;
}

using LoopEdge = std::array<Index, 2>;

/// Every edge of every loop and inner edge, once, smaller vertex first.
inline std::set<LoopEdge> allEdges(const CoarseComplex& complex) {
  std::set<LoopEdge> out;
  for (const CoarsePolygon& p : complex.polygons) {
    for (const auto& loop : p.loops) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const Index a = loop[k];
        const Index b = loop[(k + 1) % loop.size()];
        out.insert({std::min(a, b), std::max(a, b)});
      }
    }
    out.insert(p.inner_edges.begin(), p.inner_edges.end());
  }
  return out;
}

/// Vector area of all loops; along the normal if outer loops go round it the right way.
inline Vec3 vectorArea(const CoarseComplex& complex, const CoarsePolygon& p) {
  Vec3 sum(0.0);
  for (const auto& loop : p.loops) {
    const Vec3 o = complex.vertices[loop[0]];
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      sum += glm::cross(complex.vertices[loop[k]] - o, complex.vertices[loop[k + 1]] - o);
    }
  }
  return 0.5 * sum;
}

inline double segmentDistance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0, 1.0);
  return glm::distance(p, a + t * d);
}

/// The angle the loops make around a point of the plane, over 2 pi: 1 inside, 0 outside.
inline double turnsAround(const CoarseComplex& complex, const CoarsePolygon& p, const Vec3& at) {
  double angle = 0;
  for (const auto& loop : p.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3 a = complex.vertices[loop[k]] - at;
      const Vec3 b = complex.vertices[loop[(k + 1) % loop.size()]] - at;
      angle += std::atan2(glm::dot(p.normal, glm::cross(a, b)), glm::dot(a, b));
    }
  }
  return angle / (2.0 * std::acos(-1.0));
}

inline void checkShape(const CoarseComplex& complex) {
  for (const CoarsePolygon& p : complex.polygons) {
    EXPECT_TRUE(p.front);
    EXPECT_NEAR(glm::length(p.normal), 1.0, 1e-12);  // a few roundings of a unit vector
    ASSERT_FALSE(p.loops.empty());
    for (std::size_t l = 0; l < p.loops.size(); ++l) {
      ASSERT_GE(p.loops[l].size(), 3u);
      const std::set<Index> once(p.loops[l].begin(), p.loops[l].end());
      EXPECT_EQ(once.size(), p.loops[l].size()) << "a loop visits a vertex twice";
      CoarsePolygon single = p;
      single.loops = {p.loops[l]};
      const double area = glm::dot(vectorArea(complex, single), p.normal);
      EXPECT_EQ(area > 0, l == 0) << "outer loop first, then holes";
      for (const Index v : p.loops[l]) {
        const double off =
            glm::dot(complex.vertices[v] - complex.vertices[p.loops[0][0]], p.normal);
        EXPECT_LE(std::abs(off), complex.coincidence);
      }
    }
    for (const auto& [a, b] : p.inner_edges) {
      // The middle of an inner edge is inside the polygon: once around, to a rounding.
      const Vec3 middle = 0.5 * (complex.vertices[a] + complex.vertices[b]);
      EXPECT_NEAR(turnsAround(complex, p, middle), 1.0, 1e-6);
    }
    EXPECT_FALSE(p.faces.empty());
  }
}

/// No vertex inside an edge; no edge through the inside of a polygon.
inline void checkConforming(const CoarseComplex& complex) {
  const std::set<LoopEdge> edges = allEdges(complex);
  std::set<Index> used;
  for (const auto& e : edges) used.insert(e.begin(), e.end());
  EXPECT_EQ(used.size(), complex.vertices.size()) << "a vertex without an edge";
  for (const auto& [a, b] : edges) {
    for (const Index v : used) {
      if (v == a || v == b) continue;
      EXPECT_GE(segmentDistance(complex.vertices[v], complex.vertices[a], complex.vertices[b]),
                complex.coincidence)
          << "T-junction: vertex " << v << " on edge " << a << "-" << b;
    }
    for (const CoarsePolygon& p : complex.polygons) {
      const Vec3 o = complex.vertices[p.loops[0][0]];
      const double da = glm::dot(complex.vertices[a] - o, p.normal);
      const double db = glm::dot(complex.vertices[b] - o, p.normal);
      if (std::min(da, db) > -2.0 * complex.coincidence ||
          std::max(da, db) < 2.0 * complex.coincidence) {
        continue;
      }
      const Vec3 at =
          complex.vertices[a] + (complex.vertices[b] - complex.vertices[a]) * (da / (da - db));
      bool on_border = false;
      for (const auto& e : edges) {
        on_border = on_border || segmentDistance(at, complex.vertices[e[0]],
                                                 complex.vertices[e[1]]) <= complex.coincidence;
      }
      if (on_border &&
          segmentDistance(at, complex.vertices[a], complex.vertices[a]) < complex.coincidence) {
        continue;
      }
      EXPECT_LT(turnsAround(complex, p, at), 0.5) << "edge " << a << "-" << b << " pierces";
    }
  }
}

/// given = kept + buried + overlapped + degenerate on every surface.
inline void checkAreas(const Built& built, bool exact = true) {
  std::vector<double> kept(built.report.surfaces.size(), 0.0);
  for (const CoarsePolygon& p : built.complex.polygons) {
    kept[p.surface] += glm::dot(vectorArea(built.complex, p), p.normal);
  }
  for (std::size_t s = 0; s < kept.size(); ++s) {
    const SurfaceAreas& a = built.report.surfaces[s];
    // 1e-12: sums of a few hundred products that are each good to 1e-16.
    EXPECT_NEAR(kept[s] + a.buried + a.overlapped + a.degenerate, a.given, 1e-12 * a.given)
        << a.name;
    if (exact) {
      EXPECT_EQ(a.degenerate, 0.0) << a.name;
    }
  }
}

inline void checkOpposites(const CoarseComplex& complex) {
  for (std::size_t k = 0; k < complex.polygons.size(); ++k) {
    const CoarsePolygon& p = complex.polygons[k];
    if (p.opposite == kNone) continue;
    const CoarsePolygon& other = complex.polygons[p.opposite];
    EXPECT_EQ(other.opposite, k);
    EXPECT_LT(glm::dot(p.normal, other.normal), -0.999999);
    EXPECT_EQ(p.inner_edges, other.inner_edges);
    ASSERT_EQ(p.loops.size(), other.loops.size());
    std::set<std::set<Index>> mine;
    std::set<std::set<Index>> theirs;
    for (const auto& l : p.loops) mine.insert({l.begin(), l.end()});
    for (const auto& l : other.loops) theirs.insert({l.begin(), l.end()});
    EXPECT_EQ(mine, theirs);
  }
}

inline void checkAll(const Built& built, bool exact = true) {
  checkShape(built.complex);
  checkConforming(built.complex);
  checkAreas(built, exact);
  checkOpposites(built.complex);
}

inline std::size_t polygonsOf(const Built& built, Index surface) {
  return std::size_t(std::count_if(built.complex.polygons.begin(), built.complex.polygons.end(),
                                   [&](const CoarsePolygon& p) { return p.surface == surface; }));
}

/// The only polygon of a surface.
inline const CoarsePolygon& onlyPolygon(const Built& built, Index surface) {
  EXPECT_EQ(polygonsOf(built, surface), 1u);
  return *std::find_if(built.complex.polygons.begin(), built.complex.polygons.end(),
                       [&](const CoarsePolygon& p) { return p.surface == surface; });
}

}  // namespace radiosity::test
