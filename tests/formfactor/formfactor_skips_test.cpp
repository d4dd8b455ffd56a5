// Polygons that are not drawn: the reasons, and unchanged results.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "formfactor/hemicube/row_builder.h"
#include "formfactor/hidden_backs.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using Loop = MeshBuilder::Loop;

FormFactorReport reportOf(const PatchMesh& mesh, int resolution = 32) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  Progress silent;
  return computeFormFactors(mesh, options, silent).report;
}

/// Every polygon is either skipped for one reason or offered to all five faces.
void expectCountsAddUp(const FormFactorReport& report) {
  const HemicubeReport& r = report.hemicube;
  EXPECT_EQ(r.hemicubes * report.polygons, r.skipped_own_plane + r.skipped_horizon +
                                               r.skipped_facing_away +
                                               (r.rasterised_polygons + r.skipped_face) / 5);
  EXPECT_EQ((r.rasterised_polygons + r.skipped_face) % 5, 0u);
}

double drawnPerHemicube(const HemicubeReport& r) {
  return double(r.rasterised_polygons) / double(r.hemicubes);
}

TEST(Skips, QuadruplingThePatchesDrawsNoMorePolygonsPerHemicube) {
  for (const int n : {2, 4, 8}) {
    const FormFactorReport coarse = reportOf(test::roomWithBlock(n / 2).build());
    const FormFactorReport fine = reportOf(test::roomWithBlock(n).build());
    EXPECT_EQ(coarse.polygons, fine.polygons);
    EXPECT_EQ(fine.hemicube.hemicubes, 4 * coarse.hemicube.hemicubes);
    // Eyes stand elsewhere, so which faces a polygon misses varies a little.
    EXPECT_NEAR(drawnPerHemicube(fine.hemicube), drawnPerHemicube(coarse.hemicube), 2.0);
    expectCountsAddUp(coarse);
    expectCountsAddUp(fine);
  }
}

TEST(Skips, TheSameEyeDrawsTheSamePolygonsHoweverFineThePatches) {
  const auto drawn = [](int n) {
    const ViewScene scene(test::roomWithBlock(n).build());
    const DeltaFormFactors weights(64);
    Hemicube hemicube(scene, weights, rasterKernels(true));
    hemicube.look(eyeFrame(Vec3(0.8, 0.2, 0.3) * scene.scale, Vec3(0.6, 0, 0.8), 1.0), kNone,
                  nullptr);
    return hemicube.counts().rasterised_polygons;
  };
  EXPECT_EQ(drawn(1), drawn(2));
  EXPECT_EQ(drawn(1), drawn(16));
}

TEST(Skips, PolygonsInTheEyesPlaneAreSkipped) {
  // Two coplanar floors: an eye on one looks at neither.
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 1);
  builder.grid("rug", {1, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  const FormFactorReport r = reportOf(builder.build());
  EXPECT_EQ(r.hemicube.skipped_own_plane, 3u * 2 + 1u);
  expectCountsAddUp(r);
}

TEST(Skips, PolygonsInTheEyesPlaneAreSkippedAfterARotation) {
  // Coplanar only to rounding.
  const double c = std::cos(1.0), s = std::sin(1.0);
  const auto turn = [&](double x, double y) {
    return Vec3(c * x - 0.6 * s * y, s * x + 0.6 * c * y, 0.8 * y);
  };
  MeshBuilder builder;
  builder.polygon("a", {{turn(0, 0), turn(1, 0), turn(1, 1), turn(0, 1)}});
  builder.polygon("b", {{turn(0.2, 0.3), turn(0.9, 0.4), turn(0.7, 0.9)}});  // on top of a
  const FormFactorReport r = reportOf(builder.build());
  EXPECT_EQ(r.hemicube.skipped_own_plane, 4u);
  EXPECT_EQ(r.hemicube.rasterised_polygons, 0u);
}

TEST(Skips, PolygonsBelowTheHorizonAreSkipped) {
  // From each face of a convex solid all other faces lie behind.
  MeshBuilder builder;
  builder.box("solid", {0, 0, 0}, {1, 1, 1}, 2);
  const FormFactorReport r = reportOf(builder.build());
  EXPECT_EQ(r.hemicube.skipped_own_plane, 24u);
  EXPECT_EQ(r.hemicube.skipped_horizon, 24u * 5);
  EXPECT_EQ(r.hemicube.rasterised_polygons, 0u);
  EXPECT_EQ(r.hemicube.pixels, 24u * (32 * 32 + 4 * 32 * 16));
  EXPECT_FALSE(r.closed);
}

TEST(Skips, PolygonsFacingAwayAreSkipped) {
  // A cube floating in a cubic room. The centre of each wall sees one face of the cube; the five
  // others show it their backs. The cube's own faces see no black back at all.
  MeshBuilder builder;
  builder.box("room", {-1, -1, -1}, {1, 1, 1}, 1, true);
  builder.box("cube", {-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}, 1);
  const FormFactorReport r = reportOf(builder.build());
  EXPECT_EQ(r.hemicube.skipped_facing_away, 6u * 5);
  EXPECT_TRUE(r.closed);
  expectCountsAddUp(r);
}

TEST(Skips, PolygonsOutsideAFaceAreSkipped) {
  // A small square overhead is on the top face only.
  MeshBuilder builder;
  builder.grid("floor", {-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("lamp", {-0.1, -0.1, 1}, {0, 0.2, 0}, {0.2, 0, 0});
  const ViewScene scene(builder.build());
  const DeltaFormFactors weights(32);
  Hemicube hemicube(scene, weights, rasterKernels(true));
  hemicube.look(eyeFrame(Vec3(0.0), Vec3(0, 0, 1), 0.3), 0, nullptr);
  EXPECT_EQ(hemicube.counts().skipped_face, 4u);
  EXPECT_EQ(hemicube.counts().rasterised_polygons, 1u);
}

TEST(HiddenBacks, LeavingThemOutChangesNoPixel) {
  MeshBuilder builder = test::roomWithBlock(2);
  builder.box("floating", {0.65, 0.1, 0.5}, {0.85, 0.35, 0.9}, 2);
  const PatchMesh mesh = builder.build();
  const ViewScene scene(mesh);
  const HiddenBacks backs(scene, mesh);
  const DeltaFormFactors weights(64);
  Hemicube with(scene, weights, rasterKernels(true));
  Hemicube without(scene, weights, rasterKernels(true));
  std::mt19937_64 random(21);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::uint8_t> hidden;
  for (int k = 0; k < 300; ++k) {
    // Above the block, away from the floating one: in the fronts' region of both surfaces.
    const Vec3 eye(0.6 * unit(random), unit(random), 0.46 + 0.5 * unit(random));
    const Vec3 normal =
        glm::normalize(Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5));
    const EyeFrame frame = eyeFrame(eye * scene.scale, normal, unit(random));
    backs.fromEye(eye, kNone, hidden);
    const std::span<const double> all = without.look(frame, kNone, nullptr).items;
    const std::span<const double> fewer = with.look(frame, kNone, hidden.data()).items;
    ASSERT_TRUE(std::equal(all.begin(), all.end(), fewer.begin(), fewer.end())) << k;
  }
  EXPECT_GT(with.counts().skipped_facing_away, 300u * 3);
}

TEST(HiddenBacks, AreKeptForEyesOnTheOtherSide) {
  // Inside the solid cube, and outside the room, the eye sees backs.
  MeshBuilder builder;
  builder.box("cube", {0, 0, 0}, {1, 1, 1}, 1);
  const PatchMesh mesh = builder.build();
  const ViewScene scene(mesh);
  const HiddenBacks backs(scene, mesh);
  std::vector<std::uint8_t> hidden;
  backs.fromEye(Vec3(0.5), kNone, hidden);
  EXPECT_EQ(std::count(hidden.begin(), hidden.end(), 1), 0);
  backs.fromEye(Vec3(0.5, 0.5, 2), kNone, hidden);
  EXPECT_EQ(std::count(hidden.begin(), hidden.end(), 1), 6);
}

TEST(HiddenBacks, PlatesWithoutThicknessShowTheirFronts) {
  // Two polygons back to back, in an open scene: depths are equal, yet no back is ever seen.
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 4, 4);
  builder.grid("above", {0.25, 0.25, 0.4}, {0.5, 0, 0.1}, {0, 0.5, 0});
  builder.grid("below", {0.25, 0.25, 0.4}, {0, 0.5, 0}, {0.5, 0, 0.1});
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 64;
  Progress silent;
  const FormFactors f = computeFormFactors(builder.build(), options, silent);
  for (std::size_t i = 0; i < 32; ++i) EXPECT_EQ(f.backs[i], 0.0);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_GT(f.matrix->at(i, 33), 0.0);
}

}  // namespace
}  // namespace radiosity
