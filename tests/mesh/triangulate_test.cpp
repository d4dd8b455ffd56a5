// Triangles of planar polygons: they tile, use the corners given, and say where loops cross.
#include "mesh/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "base/geometry/plane_frame.h"

namespace radiosity {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

double areaOf(const std::vector<Vec2>& p, const std::array<Index, 3>& t) {
  return 0.5 * cross2(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
}

TEST(TriangulateOutline, FewAndManyCornersAreTiledByAllTheirTriangles) {
  for (const int n : {40, 3000}) {
    for (const bool clockwise : {false, true}) {
      std::vector<Vec2> outline;
      for (int k = 0; k < n; ++k) {
        const double a = (clockwise ? -2 : 2) * std::numbers::pi * k / n;
        const double r = k % 2 == 0 ? 1.0 : 0.6;
        outline.emplace_back(r * std::cos(a), r * std::sin(a));
      }
      const auto triangles = triangulateOutline(outline);
      ASSERT_EQ(triangles.size(), std::size_t(n) - 2);
      double sum = 0;
      for (const auto& t : triangles) {
        EXPECT_GE((clockwise ? -1 : 1) * areaOf(outline, t), 0);
        sum += areaOf(outline, t);
      }
      // Of n corners in pairs: n / 2 kites; sums of n products.
      const double expected = 0.5 * n * 0.6 * std::sin(2 * std::numbers::pi / n);
      EXPECT_NEAR(std::abs(sum), expected, 1e-12);
    }
  }
}

TEST(TriangulateOutline, ManyCornersThatTouchThemselvesStillGiveAllTriangles) {
  // A ring cut open: the cut is passed twice, its corners are there twice.
  std::vector<Vec2> outline;
  const int n = 100;
  for (int k = 0; k <= n; ++k) {
    const double a = 2 * std::numbers::pi * (k % n) / n;
    outline.emplace_back(2 * std::cos(a), 2 * std::sin(a));
  }
  for (int k = n; k >= 0; --k) {
    const double a = 2 * std::numbers::pi * (k % n) / n;
    outline.emplace_back(std::cos(a), std::sin(a));
  }
  const auto triangles = triangulateOutline(outline);
  EXPECT_EQ(triangles.size(), outline.size() - 2);
  double sum = 0;
  for (const auto& t : triangles) sum += areaOf(outline, t);
  EXPECT_NEAR(sum, 0.5 * n * std::sin(2 * std::numbers::pi / n) * 3, 1e-12);
}

/// Loops of points in the plane z = x / 2 + y / 3, where PlaneImage drops z and rounds nothing.
struct Tilted {
  std::vector<Vec3> vertices;
  std::vector<std::vector<Index>> loops;
  Vec3 normal = glm::normalize(Vec3(-1.0 / 2, -1.0 / 3, 1));

  Tilted& loop(const std::vector<Vec2>& corners) {
    std::vector<Index>& added = loops.emplace_back();
    for (const Vec2& p : corners) {
      added.push_back(Index(vertices.size()));
      vertices.emplace_back(p.x, p.y, p.x / 2 + p.y / 3);
    }
    return *this;
  }
  std::optional<Triangles> triangles() const {
    const std::vector<std::span<const Index>> spans(loops.begin(), loops.end());
    return triangulatePolygon(vertices, spans, normal);
  }
  /// The area above the plane z = 0 of triangles that all turn counter-clockwise there; NaN if one
  /// does not.
  double coveredFrom(const Triangles& triangles) const {
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
      const double area = 0.5 * glm::cross(vertices[b] - vertices[a], vertices[c] - vertices[a]).z;
      if (!(area > 0)) return std::numeric_limits<double>::quiet_NaN();
      sum += area;
    }
    return sum;
  }
};

/// Corners are small whole numbers: areas are sums without rounding.
void expectTiles(const Tilted& polygon, std::size_t count, double area) {
  const std::optional<Triangles> triangles = polygon.triangles();
  ASSERT_TRUE(triangles);
  EXPECT_EQ(triangles->size(), count);
  EXPECT_DOUBLE_EQ(polygon.coveredFrom(*triangles), area);
}

const std::vector<Vec2> kSquare{{0, 0}, {8, 0}, {8, 8}, {0, 8}};

TEST(TriangulatePolygon, TilesTrianglesAndQuadrilaterals) {
  expectTiles(Tilted().loop({{0, 0}, {4, 0}, {0, 4}}), 1, 8);
  expectTiles(Tilted().loop(kSquare), 2, 64);
  // If a corner turns inward, or lies in line, only one diagonal is valid.
  for (std::size_t first = 0; first < 4; ++first) {
    std::vector<Vec2> arrow{{0, 0}, {4, 1}, {8, 0}, {4, 8}};
    std::vector<Vec2> straight{{0, 0}, {4, 0}, {8, 0}, {4, 8}};
    std::rotate(arrow.begin(), arrow.begin() + std::ptrdiff_t(first), arrow.end());
    std::rotate(straight.begin(), straight.begin() + std::ptrdiff_t(first), straight.end());
    expectTiles(Tilted().loop(arrow), 2, 28);
    expectTiles(Tilted().loop(straight), 2, 32);
  }
}

TEST(TriangulatePolygon, CutsAQuadrilateralAlongItsShorterDiagonal) {
  const auto triangles = Tilted().loop({{0, 0}, {8, 2}, {9, 9}, {2, 8}}).triangles();
  ASSERT_TRUE(triangles);
  EXPECT_EQ(*triangles, (Triangles{{0, 1, 3}, {1, 2, 3}}));
}

TEST(TriangulatePolygon, LeavesHolesOutAndFillsIslandsInThem) {
  const std::vector<Vec2> hole{{1, 1}, {1, 6}, {6, 6}, {6, 1}};
  const std::vector<Vec2> island{{2, 2}, {4, 2}, {2, 4}};
  expectTiles(Tilted().loop(kSquare).loop(hole), 8, 39);
  expectTiles(Tilted().loop(kSquare).loop(hole).loop(island), 9, 41);
  // The order of the loops does not matter.
  expectTiles(Tilted().loop(island).loop(hole).loop(kSquare), 9, 41);
}

TEST(TriangulatePolygon, LetsLoopsTouchInCornersAndAlongEdges) {
  // A hole with a corner in a corner, with one on an edge, and along an edge.
  expectTiles(Tilted().loop(kSquare).loop({{0, 0}, {2, 6}, {6, 2}}), 5, 48);
  expectTiles(Tilted().loop(kSquare).loop({{4, 0}, {2, 6}, {6, 6}}), 6, 52);
  expectTiles(Tilted().loop(kSquare).loop({{2, 0}, {4, 4}, {6, 0}}), 5, 56);
  // A slit, which the outline runs along twice, leads to a hole.
  expectTiles(Tilted().loop(
                  {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {0, 0}, {2, 2}, {2, 6}, {6, 6}, {6, 2}, {2, 2}}),
              8, 48);
}

TEST(TriangulatePolygon, RefusesLoopsThatCrossOverlapOrTurnTheWrongWay) {
  EXPECT_FALSE(Tilted().loop({{0, 0}, {8, 8}, {8, 0}, {0, 8}}).triangles());
  EXPECT_FALSE(Tilted().loop({{0, 0}, {8, 0}, {2, 4}, {8, 8}, {0, 8}, {6, 4}}).triangles());
  EXPECT_FALSE(Tilted().loop(kSquare).loop({{4, 4}, {4, 12}, {12, 4}}).triangles());
  EXPECT_FALSE(Tilted().loop(kSquare).loop(kSquare).triangles());
  EXPECT_FALSE(Tilted().loop(kSquare).loop({{2, 2}, {6, 2}, {2, 6}}).triangles());
  EXPECT_FALSE(Tilted().loop({{0, 0}, {0, 8}, {8, 0}}).triangles());
}

TEST(TriangulatePolygon, GivesNothingForPolygonsWithoutArea) {
  expectTiles(Tilted().loop({{0, 0}, {4, 4}, {8, 8}}), 0, 0);
  expectTiles(Tilted().loop({{0, 0}, {4, 4}, {8, 8}, {2, 2}}), 0, 0);
}

TEST(TriangulatePolygon, TilesAThousandHolesWithAllTheirCorners) {
  Tilted polygon;
  const Index side = 32;
  polygon.loop({{0, 0}, {4.0 * side, 0}, {4.0 * side, 4.0 * side}, {0, 4.0 * side}});
  for (Index i = 0; i < side * side; ++i) {
    const Vec2 p(4 * (i % side) + 1, 4 * (i / side) + 1);
    polygon.loop({p, p + Vec2(0, 2), p + Vec2(2, 2), p + Vec2(2, 0)});
  }
  // By Euler's formula: corners + 2 (holes - 1).
  expectTiles(polygon, 4 + 4 * side * side + 2 * (side * side - 1), 12.0 * side * side);
}

}  // namespace
}  // namespace radiosity
