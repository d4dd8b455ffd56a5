// The area that shadows leave of a polygon in its plane: against closed forms, and against lines
// across it, on which shadows are intervals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "formfactor/exact/occluded/visible_pieces.h"

namespace radiosity {
namespace {

/// Coordinates up to 1 in double precision.
constexpr double kNoise = 1e-15;
constexpr std::array<Vec2, 4> kUnitSquare = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};

using Shadow = std::vector<ShadowSide>;

Shadow rectangle(double u0, double u1, double v0, double v1) {
  return {{1, 0, -u0}, {-1, 0, u1}, {0, 1, -v0}, {0, -1, v1}};
}

/// Regular, about a circle.
Shadow regular(const Vec2& centre, double radius, int sides) {
  Shadow shadow;
  for (int k = 0; k < sides; ++k) {
    const Vec2 out(std::cos(2 * M_PI * k / sides), std::sin(2 * M_PI * k / sides));
    shadow.push_back({-out.x, -out.y, radius + out.x * centre.x + out.y * centre.y});
  }
  return shadow;
}

double area(const VisiblePieces& pieces) {
  double twice = 0;
  pieces.forEdges([&](const Vec2& a, const Vec2& b) { twice += a.x * b.y - b.x * a.y; });
  return 0.5 * twice;
}

double visibleArea(std::span<const Vec2> polygon, const std::vector<Shadow>& shadows) {
  VisiblePieces pieces;
  pieces.begin(polygon);
  for (const Shadow& shadow : shadows) {
    const double before = area(pieces);
    if (!pieces.subtract(shadow, kNoise)) {
      EXPECT_EQ(area(pieces), before);
    }
  }
  EXPECT_EQ(pieces.empty(), area(pieces) == 0);
  return area(pieces);
}

TEST(VisiblePieces, AShadowOfManySidesHidesItsArea) {
  const int sides = 100;
  const double inside = sides * 0.3 * 0.3 * std::tan(M_PI / sides);
  EXPECT_NEAR(visibleArea(kUnitSquare, {regular({0.5, 0.5}, 0.3, sides)}), 1 - inside, 1e-14);
  // Around the square it hides all, beside it nothing.
  EXPECT_EQ(visibleArea(kUnitSquare, {regular({0.5, 0.5}, 0.8, sides)}), 0);
  EXPECT_EQ(visibleArea(kUnitSquare, {regular({1.5, 1.5}, 0.6, sides)}), 1);
}

TEST(VisiblePieces, ShadowsThatOverlapCountOnce) {
  const double left =
      visibleArea(kUnitSquare, {rectangle(0.1, 0.5, 0.2, 0.7), rectangle(0.3, 0.9, 0.4, 0.8),
                                rectangle(0.2, 0.4, 0.3, 0.6)});
  EXPECT_NEAR(left, 1 - (0.4 * 0.5 + 0.6 * 0.4 - 0.2 * 0.3), 1e-15);
}

TEST(VisiblePieces, ShadowsSideBySideLeaveNoGap) {
  // Thin ones, like books: borders computed twice, from points of their own, so that they agree to
  // the last digits only.
  constexpr int kBooks = 61;
  std::vector<Shadow> books;
  books.reserve(kBooks);
  for (int k = 0; k < kBooks; ++k) {
    const double at = double(k) / kBooks;
    const double next = at + 1.0 / kBooks;
    books.push_back(rectangle(at, next, -0.1, k % 2 == 0 ? 0.6 : 0.7));
  }
  const double low = 0.6 * 31 / kBooks + 0.7 * 30 / kBooks;
  EXPECT_NEAR(visibleArea(kUnitSquare, books), 1 - low, 1e-14);
  std::shuffle(books.begin(), books.end(), std::mt19937_64(3));
  EXPECT_NEAR(visibleArea(kUnitSquare, books), 1 - low, 1e-14);
}

/// Length of the part of a line along v that is in none of the shadows.
double visibleLength(double u, const std::vector<Shadow>& shadows) {
  std::vector<std::pair<double, double>> hidden;
  for (const Shadow& shadow : shadows) {
    double from = 0;
    double to = 1;
    for (const ShadowSide& side : shadow) {
      const double at_u = side.a * u + side.c;
      if (side.b > 0) from = std::max(from, -at_u / side.b);
      if (side.b < 0) to = std::min(to, -at_u / side.b);
      if (side.b == 0 && at_u < 0) to = from;
    }
    if (from < to) hidden.emplace_back(from, to);
  }
  std::sort(hidden.begin(), hidden.end());
  double seen = 0;
  double end = 0;
  for (const auto& [from, to] : hidden) {
    seen += std::max(0.0, from - end);
    end = std::max(end, to);
  }
  return seen + (1 - end);
}

TEST(VisiblePieces, AreaMatchesLinesAcross) {
  constexpr int kLines = 4000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int scene = 0; scene < 30; ++scene) {
    std::vector<Shadow> shadows;
    for (int k = 0; k < 3 + 2 * scene; ++k) {
      const Vec2 centre(uniform(random), uniform(random));
      shadows.push_back(regular(centre, 0.02 + 0.1 * uniform(random), 3 + k % 5));
    }
    double expected = 0;
    for (int k = 0; k < kLines; ++k) {
      expected += visibleLength((k + 0.5) / kLines, shadows) / kLines;
    }
    // The length is continuous but for upright sides, of which each of some 60 polygons has one:
    // steps of 0.2 at most, each known to half the distance of lines and of either sign.
    EXPECT_NEAR(visibleArea(kUnitSquare, shadows), expected, 0.2 * std::sqrt(60.0) * 0.5 / kLines);
  }
}

TEST(VisiblePieces, OrderOfShadowsDoesNotMatter) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Shadow> shadows;
  shadows.reserve(40);
  for (int k = 0; k < 40; ++k) {
    shadows.push_back(regular({uniform(random), uniform(random)}, 0.1 * uniform(random), 4));
  }
  const double expected = visibleArea(kUnitSquare, shadows);
  EXPECT_GT(expected, 0.2);
  for (int k = 0; k < 10; ++k) {
    std::shuffle(shadows.begin(), shadows.end(), random);
    // Some hundred areas, each a sum of rounded products below 1.
    EXPECT_NEAR(visibleArea(kUnitSquare, shadows), expected, 1e-13);
  }
}

}  // namespace
}  // namespace radiosity
