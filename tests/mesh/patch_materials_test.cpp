// Reflectance and emission of patches; textures averaged over their areas.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "coarse_builder.h"
#include "support/colours.h"
#include "textures.h"

namespace radiosity {
namespace {

using test::CoarseBuilder;
using test::expectNear;
using test::meanOf;
using test::noise;
using test::rgbAt;
using test::texelOf;

PatchMesh cut(CoarseBuilder& input, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  MeshReport report;
  Progress progress;
  return subdivide(input.complex(), input.scene(), options, report, progress);
}

/// The unit square in z = 0 with the texture's top left at (0, 1), `tiles` times over each way.
void texturedSquare(CoarseBuilder& input, const Texture& texture, double tiles = 1) {
  const Index s = input.surface("wall");
  input.flat(s, {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}});
  Scene& scene = input.scene();
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.materials[0].reflectance = Vec3(1.0);
  scene.texcoords = {{0, tiles}, {tiles, tiles}, {tiles, 0}, {0, 0}};
}

TEST(PatchMaterials, ConstantMaterialsAreCopied) {
  CoarseBuilder input;
  const Index sheet = input.surface("sheet");
  input.scene().materials[0].reflectance = {0.1, 0.2, 0.3};
  input.scene().materials[0].emission = {4, 5, 6};
  input.flat(sheet, {{{0, 0}, {1, 0}, {0, 1}}}).back = true;
  const PatchMesh mesh = cut(input, 10);
  const PatchMaterials materials = patchMaterials(input.scene(), mesh);
  EXPECT_EQ(materials.bands, 3);
  ASSERT_EQ(materials.reflectance.size(), 3 * mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_EQ(rgbAt(materials.reflectance, i), Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(rgbAt(materials.emission, i), Vec3(4, 5, 6));
  }
}

TEST(PatchMaterials, WholeTextureOnOnePatchGivesItsMean) {
  // Texels are weighted by exact areas: only rounding is left. From 256 x 256 texels on halved
  // copies in single precision are summed: a few units of their last place.
  for (const auto& [width, height, tolerance] : {std::tuple{1, 1, 1e-12},
                                                 {4, 4, 1e-12},
                                                 {5, 3, 1e-12},
                                                 {64, 17, 1e-12},
                                                 {700, 301, 1e-6},
                                                 {1024, 1024, 1e-6}}) {
    CoarseBuilder input;
    const Texture texture = noise(width, height);
    texturedSquare(input, texture);
    const PatchMesh mesh = cut(input, 1);
    ASSERT_EQ(mesh.size(), 1u);
    expectNear(rgbAt(patchMaterials(input.scene(), mesh).reflectance, 0), meanOf(texture),
               tolerance);
  }
}

TEST(PatchMaterials, EmissionIsAveragedLikeReflectance) {
  CoarseBuilder input;
  const Texture texture = noise(8, 8);
  texturedSquare(input, texture);
  Scene& scene = input.scene();
  scene.materials[0].emission_texture = 0;
  scene.materials[0].emission = {7, 0, 2};
  const PatchMesh mesh = cut(input, 25);
  const PatchMaterials both = patchMaterials(scene, mesh);
  scene.materials[0].texture = kNone;
  const PatchMaterials alone = patchMaterials(scene, mesh);
  Vec3 power(0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    expectNear(rgbAt(both.emission, i), rgbAt(both.reflectance, i) * Vec3(7, 0, 2), 1e-12);
    EXPECT_EQ(rgbAt(alone.emission, i), rgbAt(both.emission, i));
    EXPECT_EQ(rgbAt(alone.reflectance, i), Vec3(1.0)) << "its factor";
    power += mesh.area[i] * rgbAt(both.emission, i);
  }
  // The emitted power does not depend on patches: the mean over the square, of area 1.
  expectNear(power, meanOf(texture) * Vec3(7, 0, 2), 1e-12);
}

TEST(PatchMaterials, TexturesRepeatOrClamp) {
  CoarseBuilder input;
  Texture texture = noise(3, 2);
  texturedSquare(input, texture, 3);
  expectNear(rgbAt(patchMaterials(input.scene(), cut(input, 1)).reflectance, 0), meanOf(texture),
             1e-12);
  // Clamped, all but the first tile shows the last column and the last row of texels.
  input.scene().textures[0].repeat = false;
  Vec3 expected(0.0);
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 9; ++i) expected += texelOf(texture, std::min(i, 2), std::min(j, 1)) / 54.0;
  }
  expectNear(rgbAt(patchMaterials(input.scene(), cut(input, 1)).reflectance, 0), expected, 1e-12);
}

TEST(PatchMaterials, EveryPatchGetsTheTexelsUnderIt) {
  CoarseBuilder input;
  const Texture texture = noise(4, 4);
  texturedSquare(input, texture);
  const PatchMesh mesh = cut(input, 16);
  ASSERT_EQ(mesh.size(), 16u);
  const PatchMaterials materials = patchMaterials(input.scene(), mesh);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const int column = int(mesh.centroid[i].x * 4);
    const int row = int((1 - mesh.centroid[i].y) * 4);  // the first row is at the top
    const float* p = texture.texels.data() + 3 * (4 * row + column);
    expectNear(rgbAt(materials.reflectance, i), {p[0], p[1], p[2]}, 1e-12);
  }
}

TEST(PatchMaterials, TheAreaWeightedSumIsTheMeanForAnyCuts) {
  for (const std::size_t patches : {7u, 150u}) {
    CoarseBuilder input;
    const Texture texture = noise(13, 9);
    texturedSquare(input, texture);
    // A contact line makes triangles and odd quadrilaterals of it.
    input.innerEdge(input.complex().polygons[0], {0.2, 0.3, 0}, {0.7, 0.6, 0});
    const PatchMesh mesh = cut(input, patches);
    const PatchMaterials materials = patchMaterials(input.scene(), mesh);
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i)
      sum += mesh.area[i] * rgbAt(materials.reflectance, i);
    expectNear(sum, meanOf(texture), 1e-12);
  }
}

TEST(PatchMaterials, APatchOverSeveralFacesAveragesThemAll) {
  CoarseBuilder input;
  Texture texture = noise(2, 1);
  texturedSquare(input, texture);
  // The square was merged from two halves; the left shows the left texel, the right the right one
  // twice over; a parallel face of the same surface further down shows neither.
  test::SceneBuilder faces;
  faces.surface("wall");
  faces.level(0, 0, 0, 0.25, 1, 0);
  faces.level(0, 0.25, 0, 1, 1, 0);
  faces.level(0, 0, 0, 1, 1, -1e-4);
  Scene& scene = faces.scene();
  scene.textures = {texture};
  scene.materials[0].texture = 0;
  scene.materials[0].reflectance = {0.5, 0.5, 0.5};
  scene.texcoords = {{0, 1}, {0.5, 1}, {0.5, 0}, {0, 0},   {0.5, 1}, {1, 1},
                     {1, 0}, {0.5, 0}, {0.1, 1}, {0.2, 1}, {0.2, 0}, {0.1, 0}};
  input.complex().polygons[0].faces = {0, 1};
  input.scene() = scene;
  const PatchMesh mesh = cut(input, 1);
  ASSERT_EQ(mesh.size(), 1u);
  const float* p = texture.texels.data();
  const Vec3 expected = 0.5 * (0.25 * Vec3(p[0], p[1], p[2]) + 0.75 * Vec3(p[3], p[4], p[5]));
  expectNear(rgbAt(patchMaterials(scene, mesh).reflectance, 0), expected, 1e-12);
}

TEST(PatchMaterials, FaceMappedToOnePointHasThatTexel) {
  CoarseBuilder input;
  const Texture texture = noise(8, 8);
  texturedSquare(input, texture);
  input.scene().texcoords.assign(4, Vec2(3.5 / 8, 6.5 / 8));
  const float* p = texture.texels.data() + 3 * (8 * 6 + 3);
  for (const std::size_t patches : {1u, 9u}) {
    const PatchMaterials materials = patchMaterials(input.scene(), cut(input, patches));
    for (std::size_t i = 0; 3 * i < materials.reflectance.size(); ++i) {
      expectNear(rgbAt(materials.reflectance, i), {p[0], p[1], p[2]}, 1e-12);
    }
  }
}

TEST(PatchMaterials, BacksShowTheFrontsTexture) {
  CoarseBuilder input;
  texturedSquare(input, noise(6, 6));
  input.complex().polygons[0].back = true;
  const PatchMesh mesh = cut(input, 9);
  const PatchMaterials materials = patchMaterials(input.scene(), mesh);
  ASSERT_EQ(mesh.size(), 18u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(rgbAt(materials.reflectance, i), rgbAt(materials.reflectance, mesh.twin[i]));
  }
}

TEST(PatchMaterials, FacesAsPatchesUseTheirOwnFace) {
  CoarseBuilder input;
  const Texture texture = noise(5, 5);
  texturedSquare(input, texture);
  MeshOptions options;
  options.faces_as_patches = true;
  MeshReport report;
  Progress progress;
  const PatchMesh mesh = facesAsPatches(input.scene(), options, report, progress);
  expectNear(rgbAt(patchMaterials(input.scene(), mesh).reflectance, 0), meanOf(texture), 1e-12);
}

TEST(PatchMaterials, SizesThatDoNotFitAreNamed) {
  const auto refusal = [](const PatchMaterials& materials, std::size_t patches) {
    try {
      materials.requireSizes(patches);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const int bands : {1, 2, 3, 5, 8}) {
    const auto width = std::size_t(bands);
    PatchMaterials good{bands, std::vector<double>(4 * width), std::vector<double>(4 * width), {}};
    EXPECT_EQ(refusal(good, 4), "") << "a dark sky may be left out";
    good.lights = {uniformSky(std::vector<double>(width, 1.0))};
    EXPECT_EQ(refusal(good, 4), "");
    EXPECT_NE(refusal(good, 5).find("reflectances are given, 5 patches"), std::string::npos);
    PatchMaterials bad = good;
    bad.emission.pop_back();
    EXPECT_NE(refusal(bad, 4).find("emissions are given, 4 patches"), std::string::npos);
    bad = good;
    bad.lights[0].strength.push_back(1);
    EXPECT_NE(refusal(bad, 4).find("the sky has"), std::string::npos);
    bad = good;
    bad.bands = 0;
    EXPECT_NE(refusal(bad, 4).find("1 or more are needed"), std::string::npos);
  }
}

}  // namespace
}  // namespace radiosity
