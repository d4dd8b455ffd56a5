// The ground truth against closed forms: unoccluded (Howell's catalogue and contour integrals
// evaluated to 20 digits), and plates with an obstacle between them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh_builder.h"
#include "truth/contour.h"
#include "truth/ground_truth.h"

namespace radiosity::truth {
namespace {

using Corners = std::vector<Vec3>;
using test::MeshBuilder;

double formFactor(const Corners& from, const Corners& to) {
  const Loop a{std::span<const Vec3>(from)};
  const Loop b{std::span<const Vec3>(to)};
  return unoccludedExchange(a, b) / (0.5 * glm::length(vectorArea(a)));
}

/// A rectangle [x0, x1] x [y0, y1] at height z facing up, or down.
Corners level(double x0, double x1, double y0, double y1, double z, bool up) {
  if (up) return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

// The closed forms are known to 12 to 15 digits; 1e-12 is what the last digit of the shorter ones
// allows.
constexpr double kDigits = 1e-12;

TEST(TruthUnoccluded, ParallelRectangles) {
  const struct {
    double a, b, c, f;
  } cases[] = {{1, 1, 1, 0.199824895698387},    {1, 1, 0.01, 0.980416602925973},
               {1, 1, 0.1, 0.826994522397257},  {1, 1, 0.5, 0.415253283577147},
               {1, 1, 2, 0.0685895888185524},   {1, 1, 5, 0.0124039773132451},
               {1, 1, 10, 0.00316205683875760}, {2, 1, 1, 0.285875384850715},
               {4, 1, 1, 0.345961460677693}};
  for (const auto& k : cases) {
    EXPECT_NEAR(formFactor(level(0, k.a, 0, k.b, 0, true), level(0, k.a, 0, k.b, k.c, false)), k.f,
                kDigits)
        << k.a << " " << k.b << " " << k.c;
  }
}

/// Two rectangles that share an edge of length l, the first w wide, the second h high, at an angle.
double hinged(double w, double h, double l, double angle) {
  const Vec3 up(h * std::cos(angle), 0, h * std::sin(angle));
  const Vec3 along(0, l, 0);
  return formFactor(level(0, w, 0, l, 0, true), {Vec3(0), along, up + along, up});
}

TEST(TruthUnoccluded, PerpendicularRectangles) {
  const struct {
    double w, h, l, f;
  } cases[] = {{1, 1, 1, 0.200043776075403},   {1, 2, 1, 0.232852602795362},
               {2, 1, 1, 0.116426301397681},   {1, 0.1, 1, 0.0432513694006859},
               {1, 0.5, 1, 0.146186679105713}, {1, 1, 2, 0.240636006176962},
               {1, 1, 10, 0.281887806787901}};
  for (const auto& k : cases) {
    EXPECT_NEAR(hinged(k.w, k.h, k.l, std::numbers::pi / 2), k.f, kDigits)
        << k.w << " " << k.h << " " << k.l;
  }
}

TEST(TruthUnoccluded, SquaresAtAnAngle) {
  const struct {
    double degrees, f;
  } cases[] = {{30, 0.6190283230908},  {45, 0.4833476954789},  {60, 0.3709053211501},
               {120, 0.0866150011183}, {135, 0.0483094478018}, {150, 0.0213453254127}};
  for (const auto& k : cases) {
    EXPECT_NEAR(hinged(1, 1, 1, k.degrees * std::numbers::pi / 180), k.f, kDigits) << k.degrees;
  }
}

TEST(TruthUnoccluded, OffsetAndTouchingSquares) {
  const Corners floor = level(0, 1, 0, 1, 0, true);
  const auto wall = [](double x, double y0, double y1, double z0, double z1) {
    return Corners{{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}};
  };
  EXPECT_NEAR(formFactor(floor, level(1, 2, 0, 1, 1, false)), 0.0860504891523, kDigits);
  EXPECT_NEAR(formFactor(floor, level(1, 2, 1, 2, 1, false)), 0.0433274095741, kDigits);
  EXPECT_NEAR(formFactor(floor, wall(0, 0, 1, 1, 2)), 0.0328088267200, kDigits);
  EXPECT_NEAR(formFactor(floor, wall(0, 1, 2, 0, 1)), 0.0405922301016, kDigits);
  EXPECT_NEAR(formFactor(floor, wall(-0.5, 0, 1, 0, 1)), 0.0761366404227, kDigits);
}

TEST(TruthUnoccluded, Triangles) {
  const Corners low = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_NEAR(formFactor(low, {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}), 0.1150492281496, kDigits);
  EXPECT_NEAR(formFactor(low, {{1, 1, 1}, {1, 0, 1}, {0, 1, 1}}), 0.0847756675488, kDigits);
  // Sharing the leg along x, right angles at the same end and at opposite ends.
  EXPECT_NEAR(formFactor(low, {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}), 0.5 - 1 / std::sqrt(12.0),
              kDigits);
  EXPECT_NEAR(formFactor(low, {{0, 0, 0}, {1, 0, 1}, {1, 0, 0}}), 0.184424034121610, kDigits);
}

TEST(TruthUnoccluded, TetrahedronAndOctahedron) {
  const Corners t = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(formFactor({t[0], t[2], t[1]}, {t[0], t[1], t[3]}), 1.0 / 3, kDigits);
  // Faces of an octahedron, fronts inward, in the octants given by signs.
  const auto face = [](double x, double y, double z) {
    Corners c = {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
    if (x * y * z > 0) std::swap(c[1], c[2]);
    return c;
  };
  EXPECT_NEAR(formFactor(face(1, 1, 1), face(1, 1, -1)), 0.1368543063969, kDigits);
  EXPECT_NEAR(formFactor(face(1, 1, 1), face(1, -1, -1)), 0.1489411180165, kDigits);
  EXPECT_NEAR(formFactor(face(1, 1, 1), face(-1, -1, -1)), 0.1426137267597, kDigits);
}

TEST(TruthUnoccluded, ClosureOfTheCubeOfTriangles) {
  // Twelve triangles: rows sum to 1 whatever the values are.
  MeshBuilder builder;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 u(0.0), v(0.0), w(0.0);
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = w[axis] = 1;
    builder.polygon("room", {{w, w + v, w + u + v, w + u}},
                    {{w, w + v, w + u + v}, {w, w + u + v, w + u}});
    builder.polygon("room", {{Vec3(0), u, u + v, v}}, {{Vec3(0), u, v}, {u, u + v, v}});
  }
  const PatchMesh mesh = builder.build();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (const double f : truthRow(mesh, i)) sum += f;
    EXPECT_NEAR(sum, 1, kDigits);
  }
}

TEST(TruthUnoccluded, WhatLiesBehindIsCutAway) {
  // A wall that reaches half below the floor's plane exchanges as its upper half does.
  const Corners floor = level(0, 1, 0, 1, 0, true);
  const Corners deep = {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(formFactor(floor, deep), 0.200043776075403, kDigits);
}

// ---- Plates with an obstacle in between

/// Unit plates one apart, and a thin obstacle of the given rectangles half-way.
PatchMesh blockedPlates(const std::vector<Corners>& obstacles, int n) {
  MeshBuilder builder;
  builder.grid("lower", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("upper", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  for (const Corners& o : obstacles) builder.polygon("obstacle", {o}, {}, true);
  return builder.build();
}

/// Form factor of the whole plates out of those of their n x n patches.
double plateToPlate(const PatchMesh& mesh, std::size_t patches, double accuracy) {
  TruthOptions options;
  options.accuracy = accuracy;
  const GroundTruth truth(mesh, options);
  double exchange = 0;
  for (std::size_t i = 0; i < patches; ++i) {
    const TruthRow row = truth.row(i);
    EXPECT_EQ(row.unfinished, 0u);
    for (std::size_t j = patches; j < 2 * patches; ++j)
      exchange += mesh.area[i] * row.form_factors[j];
  }
  return exchange;
}

struct ObstacleCase {
  const char* name;
  Corners obstacle;
  double f;
};

std::vector<ObstacleCase> obstacleCases() {
  const auto centred = [](double side) {
    return level(0.5 - side / 2, 0.5 + side / 2, 0.5 - side / 2, 0.5 + side / 2, 0.5, true);
  };
  return {{"quarter", level(0, 0.5, 0, 0.5, 0.5, true), 0.149868671773790},
          {"half", level(0, 0.5, 0, 1, 0.5, true), 0.0999124478491937},
          {"square 0.1", centred(0.1), 0.1945396236482},
          {"square 0.25", centred(0.25), 0.1694742049118},
          {"square 0.5", centred(0.5), 0.0995062945990},
          {"square 0.75", centred(0.75), 0.0294835449148},
          {"square 0.9", centred(0.9), 0.0049533100175},
          {"strip", level(0.25, 0.75, 0, 1, 0.5, true), 0.0583268459018}};
}

TEST(TruthObstructed, PlatesAsOnePatchEach) {
  // Cells between the critical lines are smooth: the values come to the digits they are known to.
  for (const ObstacleCase& k : obstacleCases()) {
    EXPECT_NEAR(plateToPlate(blockedPlates({k.obstacle}, 1), 1, 1e-10), k.f, 1e-10) << k.name;
  }
}

TEST(TruthObstructed, PlatesInPatches) {
  // The accuracy of each F_ij, 1e-7 of the mean of 36 patches' 1/36, is never summed up to more
  // than 1e-7 of a plate's row; measured figures are far below it.
  for (const ObstacleCase& k : obstacleCases()) {
    EXPECT_NEAR(plateToPlate(blockedPlates({k.obstacle}, 3), 9, 1e-7), k.f, 1e-8) << k.name;
  }
}

TEST(TruthObstructed, AnObstacleInPartsIsTheObstacle) {
  const std::vector<Corners> quarters = {
      level(0.25, 0.5, 0.25, 0.5, 0.5, true), level(0.5, 0.75, 0.25, 0.5, 0.5, true),
      level(0.25, 0.5, 0.5, 0.75, 0.5, true), level(0.5, 0.75, 0.5, 0.75, 0.5, true)};
  EXPECT_NEAR(plateToPlate(blockedPlates(quarters, 1), 1, 1e-10), 0.0995062945990, 1e-10);
}

TEST(TruthObstructed, AWindowAndItsShutterAddUp) {
  // A frame with a square hole blocks what the square alone lets through, of an obstacle that is
  // otherwise as large as the plates.
  MeshBuilder builder;
  builder.grid("lower", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("upper", {0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  Corners hole = level(0.25, 0.75, 0.25, 0.75, 0.5, true);
  std::reverse(hole.begin(), hole.end());
  builder.polygon("frame", {level(0, 1, 0, 1, 0.5, true), hole},
                  {level(0, 1, 0, 0.25, 0.5, true), level(0, 1, 0.75, 1, 0.5, true),
                   level(0, 0.25, 0.25, 0.75, 0.5, true), level(0.75, 1, 0.25, 0.75, 0.5, true)});
  EXPECT_NEAR(plateToPlate(builder.build(), 1, 1e-10), 0.199824895698387 - 0.0995062945990, 1e-10);
}

}  // namespace
}  // namespace radiosity::truth
