// Exchange areas of single pairs against published and independently computed values.
//
// Values: Howell, A Catalog of Radiation Heat Transfer Configuration Factors (C-11, C-14, C-16,
// B-3, B-4), and contour integrals in 20 to 30 digits by two routes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "formfactor/exact/unoccluded/contour.h"
#include "formfactor/exact/unoccluded/unoccluded.h"
#include "support/mesh_builder.h"
#include "visibility/clipping/point_to_polygon.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using Loop = std::vector<Vec3>;

Loop rectangle(const Vec3& origin, const Vec3& u, const Vec3& v) {
  return {origin, origin + u, origin + u + v, origin + v};
}

Vec3 newell(const Loop& loop) {
  Vec3 sum(0.0);
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    sum += glm::cross(loop[k] - loop[0], loop[k + 1] - loop[0]) * 0.5;
  }
  return sum;
}

/// F from `a` to `b`, one patch each.
double formFactor(const Loop& a, const Loop& b, double tolerance) {
  MeshBuilder builder;
  builder.polygon("a", {a});
  builder.polygon("b", {b});
  const ElementSet set(builder.build());
  const UnoccludedKernel kernel(set, tolerance, true);
  return kernel.pair(0, 1) / set.area[0];
}

struct ClosedForm {
  std::string name;
  Loop a, b;
  double value;
};

Loop turnedUp(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return rectangle({0, 0, 0}, {0, 1, 0}, {std::cos(angle), 0, std::sin(angle)});
}

std::vector<ClosedForm> closedForms() {
  const Loop unit = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto parallel = [&](double a, double b, double c, double value) {
    return ClosedForm{"parallel " + std::to_string(c), rectangle({0, 0, 0}, {a, 0, 0}, {0, b, 0}),
                      rectangle({0, 0, c}, {0, b, 0}, {a, 0, 0}), value};
  };
  const auto perpendicular = [&](double w, double h, double l, double value) {
    return ClosedForm{"perpendicular " + std::to_string(h),
                      rectangle({0, 0, 0}, {w, 0, 0}, {0, l, 0}),
                      rectangle({0, 0, 0}, {0, l, 0}, {0, 0, h}), value};
  };
  const auto shifted = [&](const char* name, const Vec3& by, const Vec3& u, const Vec3& v,
                           double value) {
    return ClosedForm{name, unit, rectangle(by, u, v), value};
  };
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0, 0, 0);
  const auto octant = [&](double i, double j, double k) {
    const Loop face = {i * x, j * y, k * z};
    return glm::dot(newell(face), face[0]) < 0 ? face : Loop{face[0], face[2], face[1]};
  };
  return {
      parallel(1, 1, 1, 0.199824895698387),
      parallel(1, 1, 0.01, 0.980416602925973),
      parallel(1, 1, 0.1, 0.826994522397257),
      parallel(1, 1, 0.5, 0.415253283577147),
      parallel(1, 1, 2, 0.0685895888185524),
      parallel(1, 1, 5, 0.0124039773132451),
      parallel(1, 1, 10, 0.00316205683875760),
      parallel(2, 1, 1, 0.285875384850715),
      parallel(4, 1, 1, 0.345961460677693),
      perpendicular(1, 1, 1, 0.200043776075403),
      perpendicular(1, 2, 1, 0.232852602795362),
      perpendicular(2, 1, 1, 0.116426301397681),
      perpendicular(1, 0.1, 1, 0.0432513694006859),
      perpendicular(1, 0.5, 1, 0.146186679105713),
      perpendicular(1, 1, 2, 0.240636006176962),
      perpendicular(1, 1, 10, 0.281887806787901),
      {"dihedral 30", unit, turnedUp(30), 0.6190283230908},
      {"dihedral 45", unit, turnedUp(45), 0.4833476954789},
      {"dihedral 60", unit, turnedUp(60), 0.3709053211501},
      {"dihedral 120", unit, turnedUp(120), 0.0866150011183},
      {"dihedral 135", unit, turnedUp(135), 0.0483094478018},
      {"dihedral 150", unit, turnedUp(150), 0.0213453254127},
      shifted("parallel shifted (1,0)", {1, 0, 1}, y, x, 0.0860504891523),
      shifted("parallel shifted (1,1)", {1, 1, 1}, y, x, 0.0433274095741),
      shifted("perpendicular, z in [1,2]", {0, 0, 1}, y, z, 0.0328088267200),
      shifted("perpendicular, touching at a corner", {0, 1, 0}, y, z, 0.0405922301016),
      shifted("perpendicular, detached by 0.5", {-0.5, 0, 0}, y, z, 0.0761366404227),
      {"triangles, aligned", {o, x, y}, {z, y + z, x + z}, 0.1150492281496},
      {"triangles, opposite halves", {o, x, y}, {x + y + z, x + z, y + z}, 0.0847756675488},
      {"triangles, one right-angled vertex", {o, x, y}, {o, z, x}, 0.5 - 1 / std::sqrt(12.0)},
      {"triangles, opposite right angles", {o, x, y}, {x, o, x + z}, 0.184424034121610},
      {"tetrahedron",
       {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}},
       {{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}},
       1.0 / 3},
      {"octahedron, edge", octant(1, 1, 1), octant(1, 1, -1), 0.1368543063969},
      {"octahedron, vertex", octant(1, 1, 1), octant(1, -1, -1), 0.1489411180165},
      {"octahedron, opposite", octant(1, 1, 1), octant(-1, -1, -1), 0.1426137267597},
  };
}

TEST(ClosedForms, PublishedValuesHoldToTenDigits) {
  for (const ClosedForm& c : closedForms()) {
    // One part in 1e10: the values are given to 12 digits or more.
    EXPECT_NEAR(formFactor(c.a, c.b, 1e-11), c.value, 1e-10 * c.value) << c.name;
    EXPECT_NEAR(formFactor(c.b, c.a, 1e-11) * glm::length(newell(c.b)),
                c.value * glm::length(newell(c.a)), 1e-10 * c.value * glm::length(newell(c.a)))
        << c.name << ", the other way";
  }
}

TEST(ClosedForms, RowsOfAFrustumSumToOne) {
  // Edges of neighbours meet at corners, others at the tip, which is cut off. Not quite square, so
  // that some edges meet nowhere.
  const Vec3 tip(0.3, 0.1, 3);
  const Loop base = {{-1, -1, 0}, {1, -1, 0}, {1, 1.5, 0}, {-1, 1, 0}};
  Loop top;
  for (const Vec3& p : base) top.push_back(p + 0.4 * (tip - p));
  std::vector<Loop> faces = {base, {top[3], top[2], top[1], top[0]}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t next = (k + 1) % 4;
    faces.push_back({base[next], base[k], top[k], top[next]});
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < faces.size(); ++j) {
      if (j != i) sum += contourExchange(faces[i], faces[j], 1e-12);
    }
    // Five values, each to 1e-12.
    EXPECT_NEAR(sum / glm::length(newell(faces[i])), 1, 5e-12) << i;
  }
}

TEST(ClosedForms, EveryToleranceIsKept) {
  for (const ClosedForm& c : closedForms()) {
    for (const double tolerance : {1e-2, 1e-3, 1e-5, 1e-7, 1e-9}) {
      EXPECT_NEAR(formFactor(c.a, c.b, tolerance), c.value, tolerance * c.value) << c.name;
    }
  }
}

TEST(ClosedForms, TurningMovingAndScalingKeepValues) {
  const auto moved = [](Loop loop) {
    for (Vec3& p : loop) {
      p = {0.6 * p.x - 0.8 * p.z, p.y, 0.8 * p.x + 0.6 * p.z};
      p = {p.x, 0.28 * p.y - 0.96 * p.z, 0.96 * p.y + 0.28 * p.z};
      p = 3e-4 * p + Vec3(0.2, -0.1, 0.05);
    }
    return loop;
  };
  for (const ClosedForm& c : closedForms()) {
    // Coordinates moved by 1e3 sizes lose 3 of 16 digits, near pairs lose some more.
    EXPECT_NEAR(formFactor(moved(c.a), moved(c.b), 1e-11), c.value, 1e-9 * c.value) << c.name;
  }
}

TEST(ClosedForms, NearlyFlatAndNearlyClosedEdgesKeepTheirBounds) {
  const Loop unit = rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (const double angle : {1e-2, 1e-4, 1e-6}) {
    const Loop flap = rectangle({0, 0, 0}, {0, 1, 0}, {std::cos(angle), 0, std::sin(angle)});
    // For a wedge of infinite length 1 - sin(angle / 2); the open ends take less than the gap.
    const double closed = formFactor(unit, flap, 1e-9);
    EXPECT_LE(closed, 1 - std::sin(angle / 2) + 1e-9);
    EXPECT_GE(closed, 1 - 3 * angle);
    const double flat_angle = std::numbers::pi - angle;
    const Loop flat =
        rectangle({0, 0, 0}, {0, 1, 0}, {std::cos(flat_angle), 0, std::sin(flat_angle)});
    const double open = formFactor(unit, flat, 1e-9);
    // 1 - cos(angle / 2) for infinite length: angle^2 / 8, and less for a square.
    EXPECT_GE(open, 0);
    // Contours keep 1e-15 of the squares' size.
    EXPECT_LE(open, angle * angle / 8 + 2e-15);
  }
}

TEST(ClosedForms, TouchingInsideAnEdgeIsTheSumOfTouchingAtVertices) {
  // A triangle stands with one corner inside an edge of the square: skew edges that meet in a T.
  const Loop triangle = {{0, 0.37, 0}, {-0.5, 0.9, 0.4}, {-0.3, 0.1, 0.8}};
  const Vec3 normal = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  ASSERT_GT(glm::dot(normal, Vec3(1, 0.5, 0)), 0);
  const auto strip = [](double from, double to) {
    return rectangle({0, from, 0}, {1, 0, 0}, {0, to - from, 0});
  };
  for (const double tolerance : {1e-5, 1e-11}) {
    const double whole = formFactor(strip(0, 1), triangle, tolerance);
    const double parts = 0.37 * formFactor(strip(0, 0.37), triangle, tolerance) +
                         0.63 * formFactor(strip(0.37, 1), triangle, tolerance);
    EXPECT_NEAR(whole, parts, 2 * tolerance * whole);
    EXPECT_GT(whole, 0.01);
  }
}

TEST(ClosedForms, SliversOfAspectAMillionHaveTheirLimits) {
  // Strips of width w under and beside a unit square: to first order in w the strip is a line, and
  // every crosswise position sees alike.
  const Loop facing = rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  const double wide = 1e-3;
  const double thin = 1e-6;
  const auto strip = [](double w) { return rectangle({0.5 - w / 2, 0, 0}, {w, 0, 0}, {0, 1, 0}); };
  const double expected = formFactor(strip(wide), facing, 1e-9);
  // The middle of the square: first-order terms vanish, the rest is of order (1e-3)^2.
  EXPECT_NEAR(formFactor(strip(thin), facing, 1e-9), expected, 1e-6 * expected);
  EXPECT_NEAR(formFactor(strip(thin), facing, 1e-5), expected, 1.1e-5 * expected);
  // A strip along the foot of a wall sees half of everything, less the loss at its ends.
  const Loop wall = rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const Loop foot = rectangle({0, 0, 0}, {thin, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(formFactor(foot, wall, 1e-5), 0.5, 1e-5);
  // Two strips a unit apart.
  const Loop above = rectangle({0.5, 0, 1}, {0, 1, 0}, {thin, 0, 0});
  // Lines of length 1 at distance 1: F / width = 2/pi integral of (1 - u)/(1 + u^2)^2 over [0, 1].
  const double lines = 0.25;
  EXPECT_NEAR(formFactor(strip(thin), above, 1e-7), thin * lines, 1e-6 * thin * lines);
}

TEST(PointToPolygon, MatchesPublishedValues) {
  // B-3 and B-4, a rectangle of unit sides over a corner.
  const Loop facing = rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, {0, 0, 1}, facing), 0.138531605994893, 1e-14);
  const Loop upright = rectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0});
  EXPECT_NEAR(pointToPolygon({0, 0, 0}, {0, 0, 1}, upright), 0.0557341970025535, 1e-14);
}

TEST(PointToPolygon, AnEnclosureSumsToOne) {
  // The five faces above the floor of a box, from points of the floor, also close to a wall.
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0, 0, 0);
  for (const Vec3 at : {Vec3(0.5, 0.5, 0), Vec3(0.1, 0.7, 0), Vec3(1e-9, 0.3, 0)}) {
    const double sum =
        pointToPolygon(at, z, rectangle(z, y, x)) + pointToPolygon(at, z, rectangle(o, y, z)) +
        pointToPolygon(at, z, rectangle(x, z, y)) + pointToPolygon(at, z, rectangle(o, z, x)) +
        pointToPolygon(at, z, rectangle(y, x, z));
    EXPECT_NEAR(sum, 1, 1e-14);
  }
}

}  // namespace
}  // namespace radiosity
