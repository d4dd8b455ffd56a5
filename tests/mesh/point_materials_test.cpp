// Materials at points of textured patches.
#include "radiosity/point_materials.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "support/colours.h"
#include "support/scene_builder.h"
#include "textures.h"

namespace radiosity {
namespace {

using test::expectNear;
using test::meanOf;
using test::noise;
using test::rgbAt;
using test::texelOf;

// Texels are single precision; places are rounded in double precision.
constexpr double kRounding = 1e-6;

/// The unit square in z = 0 with the whole texture on it, its top left at (0, 1).
Scene texturedSquare(const Texture& texture, double reflectance = 1) {
  test::SceneBuilder builder;
  builder.surface("wall");
  builder.level(0, 0, 0, 1, 1, 0);
  Scene scene = builder.scene();
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.materials[0].reflectance = Vec3(reflectance);
  scene.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return scene;
}

struct Meshed {
  Meshed(Scene from, std::size_t patches) : scene(std::move(from)) {
    Progress quiet;
    mesh = meshScene(scene, {.patches = patches}, quiet).mesh;
    materials = patchMaterials(scene, mesh);
    points = pointMaterials(scene, mesh, materials);
  }
  /// The patch whose box holds the point (of the square).
  std::size_t patchAt(const Vec3& point) const {
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      Vec3 low(1e9);
      Vec3 high(-1e9);
      for (const Index v : mesh.outline(i)) {
        low = glm::min(low, mesh.vertices[v]);
        high = glm::max(high, mesh.vertices[v]);
      }
      if (glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high))) {
        return i;
      }
    }
    ADD_FAILURE() << "no patch there";
    return 0;
  }
  Vec3 reflectanceAt(double x, double y, double spacing = 1e-6) const {
    const Vec3 point(x, y, 0);
    return points->at(patchAt(point), point, spacing).reflectance;
  }

  Scene scene;
  PatchMesh mesh;
  PatchMaterials materials;
  std::shared_ptr<const PointMaterials> points;
};

TEST(PointMaterials, TexelsHaveTheirColoursAtTheirCentres) {
  const Texture texture = noise(5, 3);
  for (const std::size_t patches : {1U, 9U}) {
    const Meshed square(texturedSquare(texture, 0.5), patches);
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 5; ++i) {
        expectNear(square.reflectanceAt((i + 0.5) / 5, 1 - (j + 0.5) / 3),
                   0.5 * texelOf(texture, i, j), kRounding);
      }
    }
  }
}

TEST(PointMaterials, BetweenTexelsTheyAreLinear) {
  const Texture texture = noise(4, 4);
  const Meshed square(texturedSquare(texture), 4);
  expectNear(square.reflectanceAt(0.25 + 0.0625, 1 - 0.375),  // a quarter of the way from 0.125
             0.25 * texelOf(texture, 0, 1) + 0.75 * texelOf(texture, 1, 1), kRounding);
}

TEST(PointMaterials, TheirMeanIsThatOfThePatch) {
  // Each texel has the same weight at 8 x 8 points a texel, and the texture repeats.
  const Texture texture = noise(6, 5);
  const Meshed square(texturedSquare(texture, 0.7), 1);
  Vec3 sum(0.0);
  for (int j = 0; j < 40; ++j) {
    for (int i = 0; i < 48; ++i) sum += square.reflectanceAt((i + 0.5) / 48, (j + 0.5) / 40);
  }
  expectNear(sum / (40.0 * 48.0), rgbAt(square.materials.reflectance, 0), kRounding);
}

TEST(PointMaterials, DetailsFinerThanTheSpacingAreAveraged) {
  const Texture texture = noise(64, 64);
  const Meshed square(texturedSquare(texture), 1);
  expectNear(square.reflectanceAt(0.3, 0.6, 1.0), meanOf(texture), kRounding);
  // At four texels a point, texels of 4 x 4 are left: means of 16 independent values spread by
  // 1/sqrt(12)/4 = .07 about .5.
  Vec3 squares(0.0);
  for (int j = 0; j < 16; ++j) {
    for (int i = 0; i < 16; ++i) {
      const Vec3 off = square.reflectanceAt((i + 0.5) / 16, (j + 0.5) / 16, 4.0 / 64) - Vec3(0.5);
      squares += off * off / 256.0;
    }
  }
  for (int b = 0; b < 3; ++b) EXPECT_NEAR(std::sqrt(squares[b]), 0.07, 0.015);
}

TEST(PointMaterials, EmissionIsThePatchsTimesAFactor) {
  const Texture texture = noise(4, 4);
  Scene scene = texturedSquare(texture);
  scene.materials[0].emission_texture = 0;
  scene.materials[0].emission = {7, 0, 2};
  const Meshed square(scene, 4);
  const Vec3 point(0.625, 0.125, 0);
  const std::size_t patch = square.patchAt(point);
  expectNear(rgbAt(square.materials.emission, patch) *
                 square.points->at(patch, point, 1e-6).emission_factor,
             Vec3(7, 0, 2) * texelOf(texture, 2, 3), 10 * kRounding);
  // Without a texture of its own emission does not vary.
  scene.materials[0].emission_texture = kNone;
  const Meshed plain(scene, 4);
  EXPECT_EQ(plain.points->at(patch, point, 1e-6).emission_factor, Vec3(1.0));
}

TEST(PointMaterials, BacksShowTheFrontsTexture) {
  Scene scene = texturedSquare(noise(4, 4));
  scene.materials[0].two_sided = true;
  const Meshed square(scene, 4);
  for (std::size_t i = 0; i < square.mesh.size(); ++i) {
    const Vec3& point = square.mesh.centroid[i];
    ASSERT_NE(square.mesh.twin[i], kNone);
    EXPECT_EQ(square.points->at(i, point, 1e-6).reflectance,
              square.points->at(square.mesh.twin[i], point, 1e-6).reflectance);
  }
}

TEST(PointMaterials, CoplanarFacesOfOnePatchKeepTheirOwnMaps) {
  const Texture texture = noise(2, 1);
  test::SceneBuilder builder;
  builder.surface("wall");
  builder.level(0, 0, 0, 0.25, 1, 0);
  builder.level(0, 0.25, 0, 1, 1, 0);
  Scene scene = builder.scene();
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.materials[0].reflectance = Vec3(1.0);
  // All of the left face shows the centre of one texel, all of the right face that of the other.
  scene.texcoords.assign(4, Vec2(0.25, 0.5));
  scene.texcoords.insert(scene.texcoords.end(), 4, Vec2(0.75, 0.5));
  const Meshed square(scene, 1);
  for (const double y : {0.0, 0.3, 1.0}) {
    expectNear(square.reflectanceAt(0.24, y), texelOf(texture, 0, 0), kRounding);
    expectNear(square.reflectanceAt(0.26, y), texelOf(texture, 1, 0), kRounding);
  }
}

TEST(PointMaterials, ManyFacesUnderOnePatchKeepTheirOwnMaps) {
  constexpr int kTiles = 12;
  const Texture texture = noise(kTiles, kTiles);
  test::SceneBuilder builder;
  builder.surface("wall");
  std::vector<Vec2> uv;
  for (int j = 0; j < kTiles; ++j) {
    for (int i = 0; i < kTiles; ++i) {
      const double step = 1.0 / kTiles;
      builder.level(0, i * step, j * step, (i + 1) * step, (j + 1) * step, 0);
      uv.insert(uv.end(), 4, Vec2((i + 0.5) * step, (j + 0.5) * step));
    }
  }
  Scene scene = builder.scene();
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.materials[0].reflectance = Vec3(1.0);
  scene.texcoords = uv;
  const Meshed square(scene, 1);
  ASSERT_EQ(square.mesh.size(), 1U);
  for (int j = 0; j < kTiles; ++j) {
    for (int i = 0; i < kTiles; ++i) {
      expectNear(square.reflectanceAt((i + 0.1) / kTiles, (j + 0.8) / kTiles),
                 texelOf(texture, i, j), kRounding);
    }
  }
}

TEST(PointMaterials, ColoursOfVerticesAreLinear) {
  test::SceneBuilder builder;
  builder.surface("wall");
  builder.level(0, 0, 0, 1, 1, 0);
  Scene scene = builder.scene();
  scene.materials[0].reflectance = Vec3(0.8);
  scene.colours = {Vec3(0.0), Vec3(1.0), Vec3(1.0), Vec3(0.0)};  // of x
  const Meshed square(scene, 4);
  for (const double x : {0.0, 0.3, 0.9}) {
    expectNear(square.reflectanceAt(x, 0.4), Vec3(0.8 * x), kRounding);
  }
}

TEST(PointMaterials, OnlyVaryingSurfacesThatAreAskedAboutAreKnown) {
  EXPECT_EQ(Meshed(
                [] {
                  Scene scene = texturedSquare(noise(2, 2));
                  scene.materials[0].texture = kNone;
                  return scene;
                }(),
                4)
                .points,
            nullptr);
  const Meshed square(texturedSquare(noise(2, 2)), 4);
  ASSERT_EQ(square.mesh.size(), 4U);
  const std::vector<std::uint8_t> wanted{0, 1, 0, 0};
  const PointMaterials some(square.scene, square.mesh, square.materials, wanted);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(square.points->varies(i));
    EXPECT_EQ(some.varies(i), i == 1);
  }
}

}  // namespace
}  // namespace radiosity
