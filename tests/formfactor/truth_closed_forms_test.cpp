// The ground truth against closed forms: unoccluded (Howell's catalogue and contour integrals
// evaluated to 20 digits), and plates with an obstacle between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "support/mesh_builder.h"
#include "truth/blocked_exchange.h"
#include "truth/closed_forms.h"
#include "truth/contour.h"
#include "truth/ground_truth.h"

namespace radiosity::truth {
namespace {

using test::cubeOfTriangles;
using test::MeshBuilder;

double formFactor(const Corners& from, const Corners& to) {
  const Loop a{std::span<const Vec3>(from)};
  const Loop b{std::span<const Vec3>(to)};
  return unoccludedExchange(a, b) / (0.5 * glm::length(vectorArea(a)));
}

TEST(TruthUnoccluded, ClosedFormsHoldToTwelveDigits) {
  // They are known to 12 to 15 digits; the last digit of the shorter ones allows 1e-12.
  for (const ClosedForm& k : closedForms()) {
    EXPECT_NEAR(formFactor(k.from, k.to), k.f, 1e-12) << k.name;
    const Vec3 a = vectorArea(Loop{std::span<const Vec3>(k.from)});
    const Vec3 b = vectorArea(Loop{std::span<const Vec3>(k.to)});
    EXPECT_NEAR(formFactor(k.to, k.from) * glm::length(b), k.f * glm::length(a), 2e-12) << k.name;
  }
}

TEST(TruthUnoccluded, RowsOfTheCubeOfTrianglesSumToOne) {
  // Twelve triangles: rows sum to 1 whatever the values are.
  const PatchMesh mesh = cubeOfTriangles();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (const double f : truthRow(mesh, i)) sum += f;
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(TruthUnoccluded, PartsBehindThePlaneAreCutAway) {
  // A wall that reaches half below the floor's plane exchanges as its upper half does.
  const Corners floor = level(0, 1, 0, 1, 0, true);
  const Corners deep = {{0, 0, -1}, {0, 1, -1}, {0, 1, 1}, {0, 0, 1}};
  EXPECT_NEAR(formFactor(floor, deep), 0.200043776075403, 1e-12);
}

// ---- Plates with an obstacle in between

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

TEST(TruthObstructed, PlatesOfOnePatchHaveTheirClosedForms) {
  // Cells between the critical lines are smooth: the values come to the digits they are known to.
  for (const ObstructedForm& k : obstructedForms()) {
    EXPECT_NEAR(plateToPlate(blockedPlates({k.obstacle}, 1), 1, 1e-10), k.f, 1e-10) << k.name;
  }
}

TEST(TruthObstructed, PlatesInPatchesHaveTheirClosedForms) {
  // The accuracy of each F_ij, 1e-7 of the mean of 36 patches' 1/36, is never summed up to more
  // than 1e-7 of a plate's row; measured figures are far below it.
  for (const ObstructedForm& k : obstructedForms()) {
    EXPECT_NEAR(plateToPlate(blockedPlates({k.obstacle}, 3), 9, 1e-7), k.f, 1e-8) << k.name;
  }
}

TEST(TruthObstructed, AnObstacleInPartsBlocksAsTheWhole) {
  const std::vector<Corners> quarters = {
      level(0.25, 0.5, 0.25, 0.5, 0.5, true), level(0.5, 0.75, 0.25, 0.5, 0.5, true),
      level(0.25, 0.5, 0.5, 0.75, 0.5, true), level(0.5, 0.75, 0.5, 0.75, 0.5, true)};
  EXPECT_NEAR(plateToPlate(blockedPlates(quarters, 1), 1, 1e-10), 0.0995062945990, 1e-10);
}

TEST(TruthObstructed, AGapOfAMillionthHasItsLimit) {
  // A strip a millionth wide along a wall's foot, roofed over a millionth up, reaches only the
  // wall's lowest millionth (Howell C-14 for w = h << l: 1 - 1/sqrt(2), less the loss at the ends,
  // some millionths of a logarithm).
  constexpr double kThin = 1e-6;
  MeshBuilder builder;
  builder.polygon("strip", {level(0, 1, 0, kThin, 0, true)});
  builder.polygon("roof", {level(0, 1, 0, kThin, kThin, false)});
  builder.polygon("wall", {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}});
  const PatchMesh mesh = builder.build();
  EXPECT_NEAR(GroundTruth(mesh).formFactor(0, 2), 1 - std::sqrt(0.5), 1e-5);
}

TEST(TruthObstructed, AWindowAndItsShutterAddUp) {
  // A frame with a square hole, otherwise as large as the plates, blocks all light that the square
  // alone lets through.
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

TEST(TruthObstructed, AStripBetweenSamplePointsIsFound) {
  // A thin stick and so many specks that not all of their critical lines are cut along: from the
  // large end most cells look clear from every point of a rule. Both ends must agree within their
  // figures.
  const auto sheet = [](const Corners& corners) {
    return Sheet(Loop{std::span<const Vec3>(corners)});
  };
  const Sheet large = sheet(level(-1, 1, -1, 1, 1, false));
  const Sheet small = sheet(level(-0.005, 0.005, -0.005, 0.005, 0, true));
  std::vector<Corners> obstacles = {level(0.1, 0.4, 0.2, 0.21, 0.5, true)};
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const double x = -0.04 + 0.004 * i;
      const double y = -0.04 + 0.004 * j;
      obstacles.push_back(level(x, x + 0.001, y, y + 0.001, 0.05, true));
    }
  }
  std::vector<Blocker> blockers;
  std::vector<const Blocker*> all(obstacles.size());
  blockers.reserve(obstacles.size());
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    blockers.emplace_back(Loop{std::span<const Vec3>(obstacles[k])});
    blockers[k].body = Index(k);
    all[k] = &blockers[k];
  }
  const double whole = unoccludedExchange(large.loop, small.loop);
  const BlockedExchange down = blockedExchange(large, small, all, 1e-7, 1e-4 * whole, 400000);
  const BlockedExchange up = blockedExchange(small, large, all, 1e-7, 1e-4 * whole, 400000);
  EXPECT_GT(up.blocked, 0.001 * whole);
  EXPECT_LE(up.error, 1e-4 * whole);
  EXPECT_LE(down.error, 1e-4 * whole);
  EXPECT_NEAR(down.blocked, up.blocked, down.error + up.error);
}

}  // namespace
}  // namespace radiosity::truth
