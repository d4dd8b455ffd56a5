// Polygons drawn front to back, hidden ones left out: the same pixels, and work for visible
// polygons only.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "formfactor/hemicube/row_builder.h"
#include "support/mesh_builder.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

/// A room without a floor, with `count` tilted plates of `size` about the heights from `low` to
/// `high`.
MeshBuilder platesInARoom(int count, double size, double low, double high) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 3, true, false);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < count; ++k) {
    const Vec3 at(0.05 + 0.9 * unit(random), 0.05 + 0.9 * unit(random),
                  low + (high - low) * unit(random));
    const Vec3 u = size * glm::normalize(Vec3(unit(random), unit(random), unit(random)) - 0.5);
    const Vec3 v = size * glm::normalize(Vec3(unit(random), unit(random), unit(random)) - 0.5);

    builder.grid("plates", at, u, v, 1 + k % 2, 1, k % 5 == 0);
    if (k % 3 == 0) builder.grid("lids", at, v, u);
  }
  return builder;
}

struct TwoWays {
  TwoWays(const PatchMesh& mesh, int resolution, const RasterKernels& kernels)
      : scene(mesh),
        weights(resolution),
        tree(scene),
        all(scene, weights, kernels),
        nearest(scene, weights, kernels, &tree) {}
  ViewScene scene;
  DeltaFormFactors weights;
  PolygonTree tree;
  Hemicube all;
  Hemicube nearest;
};

/// Looks from `eyes` random places both ways and compares all bits.
void expectSameViews(TwoWays& views, int eyes) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < eyes; ++k) {
    const Vec3 eye(0.1 + 0.8 * unit(random), 0.1 + 0.8 * unit(random), 0.9 * unit(random));
    const Vec3 normal =
        glm::normalize(Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5));
    const EyeFrame frame = eyeFrame(eye * views.scene.scale, normal, unit(random));
    const HemicubeView& expected = views.all.look(frame, kNone, nullptr);
    const HemicubeView& seen = views.nearest.look(frame, kNone, nullptr);
    ASSERT_TRUE(std::equal(expected.items.begin(), expected.items.end(), seen.items.begin())) << k;
    EXPECT_EQ(expected.fronts, seen.fronts);
    EXPECT_EQ(expected.backs, seen.backs);
    EXPECT_EQ(expected.sky, seen.sky);
    for (int face = 0; face < kFaces; ++face) {
      ASSERT_EQ(views.all.picture(face), views.nearest.picture(face)) << k << " " << face;
    }
  }
}

TEST(Hidden, LeavingPolygonsOutChangesNoPixel) {
  // Lids and plates lie in the same places: depths are equal to the bit, and the first one stays.
  const PatchMesh mesh = platesInARoom(200, 0.15, 0.2, 0.8).build();
  for (const int resolution : {16, 36, 64, 150}) {
    TwoWays views(mesh, resolution, rasterKernels(true));
    expectSameViews(views, 40);
  }
}

TEST(Hidden, LeavingPolygonsOutChangesNoPixelOnAnyInstructionSet) {
  const PatchMesh mesh = platesInARoom(60, 0.2, 0.2, 0.8).build();
  test::onEveryTarget([] { return rasterKernels(true); },
                      [&](const RasterKernels& kernels) {
                        TwoWays views(mesh, 48, kernels);
                        expectSameViews(views, 5);
                      });
}

/// Polygons rasterised by an eye on the floor under a lid, with `count` plates above the lid.
std::size_t drawnBelowALid(int count) {
  MeshBuilder builder = platesInARoom(count, 0.05, 0.6, 0.9);
  builder.grid("lid", {0, 0, 0.5}, {0, 1, 0}, {1, 0, 0});
  TwoWays views(builder.build(), 64, rasterKernels(true));
  const EyeFrame frame = eyeFrame(Vec3(0.4, 0.6, 0.01) * views.scene.scale, Vec3(0, 0, 1), 0.3);
  views.nearest.look(frame, kNone, nullptr);
  views.all.look(frame, kNone, nullptr);
  EXPECT_GT(views.all.counts().rasterised_polygons, std::size_t(count));
  EXPECT_GT(views.nearest.counts().skipped_hidden, std::size_t(count));
  return views.nearest.counts().rasterised_polygons;
}

TEST(Hidden, HiddenPolygonsAreNotDrawnHoweverMany) {
  // Some are drawn before the lid: their boxes are the nearest.
  const std::size_t few = drawnBelowALid(100);
  EXPECT_LE(drawnBelowALid(1000), few + 10);
  EXPECT_LE(drawnBelowALid(10000), few + 10);
}

TEST(Hidden, CountsAddUp) {
  const PatchMesh mesh = platesInARoom(200, 0.15, 0.2, 0.8).build();
  TwoWays views(mesh, 64, rasterKernels(true));
  expectSameViews(views, 20);
  const HemicubeReport c = views.nearest.counts();
  EXPECT_GT(c.skipped_hidden, 0u);
  EXPECT_GT(c.skipped_horizon, 0u);
  EXPECT_EQ(5 * c.hemicubes * mesh.polygons.size(),
            5 * (c.skipped_own_plane + c.skipped_horizon + c.skipped_facing_away) +
                c.rasterised_polygons + c.skipped_face + c.skipped_hidden);
}

TEST(Hidden, PolygonsAreLeftOutOnlyIfMostAreHidden) {
  FormFactorOptions options;
  options.resolution = 64;
  const auto leavesOut = [&](const MeshBuilder& builder) {
    return RowBuilder(builder.build(), options).leavesOutHidden();
  };
  EXPECT_FALSE(leavesOut(test::roomWithBlock(2)));
  EXPECT_FALSE(leavesOut(platesInARoom(120, 0.02, 0.2, 0.8)));  // many, next to none hidden
  MeshBuilder lidded = platesInARoom(3000, 0.05, 0.6, 0.9);
  lidded.grid("lid", {0, 0, 0.5}, {0, 1, 0}, {1, 0, 0}, 30, 30);
  lidded.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 30, 30);
  EXPECT_TRUE(leavesOut(lidded));
}

}  // namespace
}  // namespace radiosity
