// The nearest points beside a search of all of them.
#include "mesh/clusters/nearest_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace radiosity {
namespace {

using Points = std::vector<NearestTree::Point>;

double distance2(const NearestTree::Point& a, const NearestTree::Point& b) {
  double sum = 0;
  for (std::size_t d = 0; d < NearestTree::kDimensions; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

std::vector<Index> nearestOfAll(const Points& points, Index k, std::size_t count) {
  std::vector<std::pair<double, Index>> others;
  for (Index other = 0; other < points.size(); ++other) {
    if (other != k) others.emplace_back(distance2(points[k], points[other]), other);
  }
  std::sort(others.begin(), others.end());
  std::vector<Index> nearest;
  for (std::size_t m = 0; m < std::min(count, others.size()); ++m) {
    nearest.push_back(others[m].second);
  }
  return nearest;
}

void expectNearest(const Points& points, std::size_t count) {
  const NearestTree tree(points);
  for (Index k = 0; k < points.size(); ++k) {
    EXPECT_EQ(tree.nearestTo(k, count), nearestOfAll(points, k, count)) << k;
  }
}

TEST(NearestTree, FindsTheNearestOfPointsInSpace) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Points points(700);
  for (std::size_t k = 0; k < points.size(); ++k) {
    // A dense knot among far points.
    const double scale = k % 2 == 0 ? 1e-4 : 10;
    for (double& x : points[k]) x = scale * uniform(random);
  }
  expectNearest(points, 3);
}

// Many points are equally far: those of the lowest numbers count as nearest.
TEST(NearestTree, BreaksTiesByNumber) {
  Points points;
  for (int k = 0; k < 400; ++k) {
    points.push_back({double(k % 5), double(k / 5 % 5), double(k / 25 % 4), double(k % 2), 0, 0});
  }
  expectNearest(points, 3);
}

TEST(NearestTree, HasFewerPointsThanAskedFor) {
  expectNearest({{1, 2, 3, 4, 5, 6}, {0, 0, 0, 0, 0, 0}}, 3);
  expectNearest({{1, 2, 3, 4, 5, 6}}, 3);
}

}  // namespace
}  // namespace radiosity
