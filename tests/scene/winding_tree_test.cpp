// Winding numbers of closed surfaces: whole numbers that are known, and sums of solid angles beside
// sums of arctangents.
#include "scene/checks/winding_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "base/geometry/solid_angle.h"

namespace radiosity {
namespace {

using Triangles = std::vector<WindingTree::Triangle>;

/// Adds a sphere about the origin of 2 n (n - 1) triangles, seen from outside or from inside.
void addSphere(Triangles& triangles, double radius, int n, bool outwards = true) {
  const auto at = [&](int ring, int step) {
    const double polar = std::numbers::pi * ring / n;
    const double around = 2 * std::numbers::pi * (step % n) / n;
    return radius * Vec3(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                         std::cos(polar));
  };
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    triangles.push_back({outwards ? std::array{a, b, c} : std::array{a, c, b}, kNone});
  };
  for (int ring = 0; ring < n; ++ring) {
    for (int step = 0; step < n; ++step) {
      if (ring > 0) add(at(ring, step), at(ring + 1, step), at(ring, step + 1));
      if (ring + 1 < n) add(at(ring, step + 1), at(ring + 1, step), at(ring + 1, step + 1));
    }
  }
}

TEST(WindingTree, CountsSurfacesAroundAPoint) {
  Triangles triangles;
  for (const double radius : {1.0, 2.0, 3.0}) addSphere(triangles, radius, 12);
  const WindingTree tree(triangles);
  // The error of far triangles that count together is at most 0.05.
  EXPECT_NEAR(tree.around({0.1, -0.2, 0.3}), 3, 0.05);
  EXPECT_NEAR(tree.around({1.4, 0.1, 0.1}), 2, 0.05);
  EXPECT_NEAR(tree.around({0.2, -2.4, 0.1}), 1, 0.05);
  EXPECT_NEAR(tree.around({0.2, 0.1, 3.2}), 0, 0.05);
}

TEST(WindingTree, SurfacesThatFaceInwardsCountAgainst) {
  Triangles triangles;
  for (const double radius : {1.0, 2.0, 3.0}) addSphere(triangles, radius, 12, false);
  addSphere(triangles, 4, 12);
  EXPECT_NEAR(WindingTree(triangles).around({0.1, -0.2, 0.3}), -2, 0.05);
}

Vec3 randomPoint(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double x = uniform(random);
  const double y = uniform(random);
  return {x, y, uniform(random)};
}

TEST(SolidAngleSum, IsTheSumOfArctangents) {
  std::mt19937 random(7);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    SolidAngleSum sum;
    double expected = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 a = scale * randomPoint(random);
      const Vec3 b = scale * randomPoint(random);
      const Vec3 c = scale * randomPoint(random);
      // Every other stretch turns one way, for many turns in all.
      const bool forwards = (signedSolidAngle(a, b, c) > 0) == (k / 200 % 2 == 0);
      sum.add(forwards ? halfSolidAngle(a, b, c) : halfSolidAngle(a, c, b));
      expected += forwards ? signedSolidAngle(a, b, c) : signedSolidAngle(a, c, b);
      // Rounding of k products, 1e-16 each, and of sums of up to 1,000 sr.
      ASSERT_NEAR(sum.value(), expected, 1e-11) << k;
    }
  }
}

TEST(SolidAngleSum, TakesAnglesAtTheEndsOfTheirRange) {
  const auto sumOf = [](std::initializer_list<HalfAngle> angles) {
    SolidAngleSum sum;
    for (const HalfAngle& half : angles) sum.add(half);
    return sum.value();
  };
  const double tiny = std::numeric_limits<double>::min();
  const double pi = std::numbers::pi;
  // Halves of pi: points on a triangle, seen from its back.
  EXPECT_DOUBLE_EQ(sumOf({{-1, 0}}), 2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, 0}, {-1, 0}}), 4 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, 0}, {-1, 0}, {-1, 0}}), 6 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, -tiny}}), -2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, -tiny}, {-1, -tiny}}), -4 * pi);
  // The sign of a zero tells the side from which a point on a triangle sees it.
  EXPECT_DOUBLE_EQ(sumOf({{-1, -0.0}}), -2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, -0.0}, {-1, -0.0}}), -4 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, -0.0}, {-1, -0.0}, {-1, -0.0}}), -6 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, -0.0}, {-1, 0.0}}), 0);
  EXPECT_DOUBLE_EQ(sumOf({{1, -0.0}, {-1, -0.0}}), -2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{-1, 0.0}, {1, -0.0}}), 2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{0, -1}, {0, -1}}), -2 * pi);
  EXPECT_DOUBLE_EQ(sumOf({{0, 1}, {0, 1}}), 2 * pi);
  EXPECT_NEAR(sumOf({{-1, 0}, {-1, -tiny}}), 0, 1e-15);
  // A corner of a triangle has no solid angle.
  EXPECT_DOUBLE_EQ(sumOf({{0, 1}, {0, 0}}), pi);
}

}  // namespace
}  // namespace radiosity
