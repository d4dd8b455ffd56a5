// The tools of meshing that answer in n log n, each against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "base/geometry/plane_frame.h"
#include "mesh/arrangement/box_filter.h"
#include "mesh/arrangement/edge_rows.h"
#include "mesh/box_pairs.h"
#include "mesh/cells/join_cells.h"
#include "mesh/cells/join_loops.h"
#include "mesh/cells/region/region.h"
#include "mesh/cells/sharp_corners.h"
#include "mesh/patches/face_locator.h"
#include "mesh/welded_points.h"
#include "scene/checks/winding_tree.h"

namespace radiosity::test {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform() { return double(engine_()) / 4294967296.0; }
  Vec3 point() {
    const double x = uniform();
    const double y = uniform();
    return {x, y, uniform()};
  }
  Index below(std::size_t n) { return Index(engine_() % n); }

 private:
  std::mt19937 engine_;
};

TEST(SharpCorners, MatchASearchOfAllPairsOfEdges) {
  Random random(3);
  std::vector<Vec3> vertices;
  vertices.reserve(60);
  for (int k = 0; k < 60; ++k) vertices.push_back(random.point() * Vec3(1, 1, 1e-4));
  std::vector<std::array<Index, 2>> edges;
  // A hub with many edges, of which some leave in nearly one direction.
  edges.reserve(300);
  for (Index k = 1; k < 60; ++k) edges.push_back({0, k});
  for (int k = 0; k < 200; ++k) {
    const Index a = random.below(60);
    const Index b = random.below(60);
    if (a != b) edges.push_back({a, b});
  }
  const auto found = sharpestSines(vertices, edges);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    double smallest = 1;
    for (std::size_t j = 0; j < edges.size(); ++j) {
      for (const Index v : edges[i]) {
        if (i == j || (v != edges[j][0] && v != edges[j][1])) continue;
        const auto leave = [&](const std::array<Index, 2>& e) {
          return glm::normalize(vertices[e[0] == v ? e[1] : e[0]] - vertices[v]);
        };
        if (glm::dot(leave(edges[i]), leave(edges[j])) <= 0) continue;
        smallest = std::min(smallest, glm::length(glm::cross(leave(edges[i]), leave(edges[j]))));
      }
    }
    // The same sines, from directions of the other sign: equal but for the last bits.
    EXPECT_NEAR(found[i], smallest, 1e-15) << i;
  }
}

TEST(EdgeRows, HoldEveryEdgeNearAPlace) {
  Random random(5);
  WeldedPoints points;
  std::vector<std::array<Index, 2>> edges;
  for (int k = 0; k < 400; ++k) {
    const Vec3 p = random.point();
    // Short ones, and one in twenty across everything.
    const Vec3 q = k % 20 == 0 ? random.point() : p + 0.01 * (random.point() - 0.5);
    edges.push_back({points.insert(p, 1e-9), points.insert(q, 1e-9)});
  }
  const PlaneImage image(Vec3(0, 0, 1));
  const double margin = 1e-3;
  const EdgeRows rows(points, image, edges, margin);
  std::size_t seen = 0;
  for (int k = 0; k < 300; ++k) {
    const double low = 1.2 * random.uniform() - 0.1;
    const double high = low + 0.05 * random.uniform();
    const auto at = rows.at(low);
    const auto between = rows.between(low, high);
    seen += at.size();
    EXPECT_TRUE(std::is_sorted(between.begin(), between.end()));
    for (Index e = 0; e < edges.size(); ++e) {
      const auto [from, to] = std::minmax({points[edges[e][0]].y, points[edges[e][1]].y});
      if (low >= from - margin && low <= to + margin) {
        EXPECT_TRUE(std::find(at.begin(), at.end(), e) != at.end());
      }
      if (high >= from - margin && low <= to + margin) {
        EXPECT_TRUE(std::binary_search(between.begin(), between.end(), e));
      }
    }
  }
  EXPECT_LT(seen, 300 * edges.size() / 4) << "a row holds too many edges to be of use";
}

TEST(BoxFilter, PassesEverythingThatMeetsABox) {
  Random random(7);
  const auto box = [&](double size) {
    const Vec3 low = random.point();
    return Box3{low, low + size * random.point()};
  };
  std::vector<Box3> boxes;
  boxes.reserve(20);
  for (int k = 0; k < 20; ++k) boxes.push_back(box(0.01));
  const BoxFilter filter(boxes);
  int kept = 0;
  for (int k = 0; k < 5000; ++k) {
    const Box3 asked = box(k % 10 == 0 ? 0.5 : 0.02);
    const bool meets =
        std::any_of(boxes.begin(), boxes.end(), [&](const Box3& b) { return b.meets(asked); });
    if (meets) {
      EXPECT_TRUE(filter.mayMeet(asked));
    }
    kept += filter.mayMeet(asked) ? 1 : 0;
  }
  EXPECT_LT(kept, 2500) << "it filters nothing";
}

/// A closed torus of 2 n n triangles, outward, each in a plane of its own.
std::vector<WindingTree::Triangle> torus(int n) {
  const auto at = [n](int i, int j) {
    const double u = 2 * std::numbers::pi * i / n;
    const double v = 2 * std::numbers::pi * j / n;
    return Vec3((1 + 0.3 * std::cos(v)) * std::cos(u), (1 + 0.3 * std::cos(v)) * std::sin(u),
                0.3 * std::sin(v));
  };
  std::vector<WindingTree::Triangle> out;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      out.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, Index(out.size())});
      out.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, Index(out.size())});
    }
  }
  return out;
}

TEST(WindingTree, TellsInsideFromOutside) {
  const auto triangles = torus(48);
  const WindingTree tree(triangles);
  Random random(9);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 p = (random.point() - 0.5) * Vec3(3, 3, 1);
    const double ring = std::sqrt(p.x * p.x + p.y * p.y) - 1;
    const double depth = 0.3 - std::sqrt(ring * ring + p.z * p.z);
    if (std::abs(depth) < 0.01) continue;  // between the torus and its facets
    // Dipoles farther than three radii: hundredths, far from the half that would mislead.
    EXPECT_NEAR(tree.around(p), depth > 0 ? 1.0 : 0.0, 0.05);
  }
}

TEST(WindingTree, ATriangleCountsAsNothingInItsOwnPlane) {
  const auto triangles = torus(48);
  const WindingTree tree(triangles);
  for (Index k = 0; k < triangles.size(); k += 37) {
    const auto& [a, b, c] = triangles[k].corners;
    const Vec3 middle = (a + b + c) / 3.0;
    EXPECT_NEAR(tree.around(middle, k), 0.5, 0.05) << k;
  }
}

TEST(JoinLoops, GiveTheOutlineOfBothOrNothing) {
  using Loop = std::vector<Index>;
  // Two squares of a grid side by side, numbered along its rows of three points.
  EXPECT_EQ(joinLoops({0, 1, 4, 3}, {1, 2, 5, 4}), (Loop{0, 1, 2, 5, 4, 3}));
  EXPECT_EQ(joinLoops({4, 3, 0, 1}, {5, 4, 1, 2}), (Loop{0, 1, 2, 5, 4, 3}));
  // Squares that meet in a point, or not at all.
  EXPECT_EQ(joinLoops({0, 1, 4, 3}, {4, 5, 8, 7}), Loop());
  EXPECT_EQ(joinLoops({0, 1, 4, 3}, {5, 6, 9, 8}), Loop());
  // Seven squares around an eighth, on rows of four points, and the one that closes the ring.
  EXPECT_EQ(joinLoops({0, 1, 2, 3, 7, 11, 15, 14, 10, 6, 5, 9, 13, 12, 8, 4}, {9, 10, 14, 13}),
            Loop());
  // The same region twice, and the other way round: nothing is left.
  EXPECT_EQ(joinLoops({0, 1, 2}, {1, 2, 0}), (Loop{0, 1, 2}));
  EXPECT_EQ(joinLoops({0, 1, 2}, {2, 1, 0}), Loop());
}

using IndexPairs = std::vector<std::pair<Index, Index>>;

// A few boxes are searched one by one, more by a tree.
TEST(BoxPairs, AreThoseOfASearchOfAllPairs) {
  Random random(7);
  for (const Index count : {0u, 1u, 2u, 20u, 32u, 33u, 400u}) {
    std::vector<Box3> boxes(count);
    std::vector<Index> some;
    for (Index i = 0; i < count; ++i) {
      const Vec3 low = random.point();
      boxes[i] = {low, low + 0.3 * random.point()};
      if (i % 3 == 1) some.push_back(i);
    }
    IndexPairs all;
    IndexPairs with_some;
    IndexPairs wanted;
    for (Index i = 0; i < count; ++i) {
      for (Index j = i + 1; j < count; ++j) {
        if (!boxes[i].meets(boxes[j])) continue;
        all.emplace_back(i, j);
        if (i % 3 == 1 || j % 3 == 1) with_some.emplace_back(i, j);
        if ((i + j) % 2 == 0) wanted.emplace_back(i, j);
      }
    }
    EXPECT_EQ(overlappingPairs(boxes), all) << count;
    EXPECT_EQ(overlappingPairs(boxes, some), with_some) << count;
    const auto even = [](Index i, Index j) { return (i + j) % 2 == 0; };
    EXPECT_EQ(overlappingPairs(boxes, nullptr, even), wanted) << count;
  }
}

// A square with short pieces in one side, from which thin triangles go to far points.
TEST(MeshRegion, HasInnerPointsOnlyIfAnglesAreToImprove) {
  Region region;
  region.points = {{0, 0},   {1, 0}, {2, 0},   {2, 1}, {2, 2},
                   {1.1, 2}, {1, 2}, {0.9, 2}, {0, 2}, {0, 1}};
  region.loops = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
  region.size = 10;
  for (const bool improve : {false, true}) {
    region.improve = improve;
    const std::optional<RegionMesh> mesh = meshRegion(region);
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->interior.empty(), !improve);
    double area = 0;
    std::vector<Vec2> points = region.points;
    points.insert(points.end(), mesh->interior.begin(), mesh->interior.end());
    for (const Cell& cell : mesh->cells) {
      for (std::size_t k = 2; k < (cell[3] == kNone ? 3u : 4u); ++k) {
        area +=
            0.5 * cross2(points[cell[k - 1]] - points[cell[0]], points[cell[k]] - points[cell[0]]);
      }
    }
    EXPECT_NEAR(area, 4, 1e-14);  // some roundings of a sum of 4
  }
}

/// A grid of `n` x `n` unit squares, turned in space and numbered along its rows.
struct SquareGrid {
  explicit SquareGrid(Index n) {
    const Vec3 u = glm::normalize(Vec3(1, 2, 2));
    const Vec3 v = glm::normalize(Vec3(2, 1, -2));
    for (Index y = 0; y <= n; ++y) {
      for (Index x = 0; x <= n; ++x) points.push_back(double(x) * u + double(y) * v);
    }
    for (Index y = 0; y < n; ++y) {
      for (Index x = 0; x < n; ++x) {
        const Index a = y * (n + 1) + x;
        cells.push_back({a, a + 1, a + n + 2, a + n + 1});
      }
    }
  }
  double areaOf(std::span<const Index> outline) const {
    Vec3 sum(0.0);
    for (std::size_t k = 1; k + 1 < outline.size(); ++k) {
      sum += glm::cross(points[outline[k]] - points[outline[0]],
                        points[outline[k + 1]] - points[outline[0]]);
    }
    return 0.5 * glm::length(sum);
  }
  std::vector<Vec3> points;
  std::vector<Cell> cells;
};

TEST(JoinCells, EveryCellIsInOnePatchOfNoMoreThanTheSize) {
  const SquareGrid grid(12);
  for (const double size : {1.0, 1.5, 2.5, 4.1, 100.0}) {
    const std::vector<CellGroup> groups = joinCells(grid.cells, {}, grid.points, {size});
    std::vector<int> used(grid.cells.size(), 0);
    for (const CellGroup& group : groups) {
      for (const Index c : group.cells) ++used[c];
      EXPECT_LE(double(group.cells.size()), size * size);
      EXPECT_NEAR(grid.areaOf(group.outline), double(group.cells.size()), 1e-12 * 144);
      double triangles = 0;
      for (const auto& t : group.triangles) triangles += grid.areaOf(t);
      if (group.triangles.empty()) continue;
      EXPECT_NEAR(triangles, double(group.cells.size()), 1e-10);
    }
    EXPECT_EQ(std::ranges::count(used, 1), std::ptrdiff_t(used.size()));
    // Joined groups are more than half the allowed size on average.
    EXPECT_LT(double(groups.size()), 2 * 144 / (size * size) + 1) << size;
  }
  EXPECT_EQ(joinCells(grid.cells, {}, grid.points, {1.0}).size(), grid.cells.size());
}

TEST(JoinCells, GroupsDoNotCrossInnerEdges) {
  const SquareGrid grid(4);
  // A wall along the second row of points.
  std::vector<std::array<Index, 2>> wall;
  for (Index x = 0; x < 4; ++x) wall.push_back({10 + x, 11 + x});
  const std::vector<CellGroup> groups = joinCells(grid.cells, wall, grid.points, {3.0});
  for (const CellGroup& group : groups) {
    const bool below = group.cells.front() < 8;
    for (const Index c : group.cells) EXPECT_EQ(c < 8, below);
  }
  EXPECT_LE(groups.size(), 4u);
}

TEST(JoinCells, AThinCellIsPartOfItsNeighboursPatch) {
  // Two squares, each with a triangle of a height of 1e-7 on it.
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0},       {2, 1, 0},
                                 {1, 1, 0}, {0, 1, 0}, {1, 1 + 1e-7, 0}};
  const std::vector<Cell> cells{{0, 1, 4, 5}, {1, 2, 3, 4}, {5, 4, 6, kNone}, {4, 3, 6, kNone}};
  EXPECT_FALSE(anyThin(cells, points, 0.9e-7));
  EXPECT_TRUE(anyThin(cells, points, 1.1e-7));
  EXPECT_EQ(joinCells(cells, {}, points, {0, 0.9e-7}).size(), 4u);
  const std::vector<CellGroup> groups = joinCells(cells, {}, points, {0, 1.1e-7});
  ASSERT_EQ(groups.size(), 2u);
  for (const CellGroup& group : groups) {
    EXPECT_EQ(group.cells.size(), 2u);
    EXPECT_EQ(group.outline.size(), 5u);
  }
}

TEST(WeldPoints, AGroupIsOneOrSeveralWhateverItsOrder) {
  // In steps of 0.9 radii: the middle of three is near both others.
  const double step = 0.9e-3;
  const auto count = [&](const std::vector<double>& at) {
    std::vector<Vec3> places;
    places.reserve(at.size());
    for (const double x : at) places.emplace_back(x * step, 1, 2);
    WeldedPoints points;
    const std::vector<Index> point =
        weldPoints(places, std::vector<double>(places.size(), 1e-3), points);
    EXPECT_EQ(point.size(), places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_LT(glm::distance(points[point[k]], places[k]), 1e-3);
    }
    return points.size();
  };
  EXPECT_EQ(count({0, 1}), 1u);
  EXPECT_EQ(count({0, 2}), 2u);
  EXPECT_EQ(count({0, 1, 2}), 1u);
  EXPECT_EQ(count({2, 0, 1}), 1u);
  EXPECT_EQ(count({0, 2, 1}), 1u);
  // A chain has no middle near all.
  EXPECT_GT(count({0, 1, 2, 3, 4, 5}), 1u);
}

}  // namespace
}  // namespace radiosity::test
