// What a page has of textures: triangles cut where texture coordinates break off, and 8-bit texels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "base/srgb.h"
#include "page/texture_pieces.h"
#include "page/textures.h"
#include "page_reader.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::PageReader;
using test::SceneBuilder;

/// Two squares side by side that are meshed as one rectangle. Each has the whole texture; the red
/// of its vertices rises over the left one and falls over the right one.
Scene twoTiles(const std::vector<Vec2>& places) {
  SceneBuilder builder;
  const Index floor = builder.surface("floor", 0.5);
  builder.level(floor, 0, 0, 1, 1, 0);
  builder.level(floor, 1, 0, 2, 1, 0);
  Scene scene = builder.scene();
  scene.textures.push_back({"tile", 2, 1, {0, 0, 0, 1, 1, 1}, true});
  scene.materials[0].texture = 0;
  for (const Index v : scene.corners) {
    const bool is_middle = scene.vertices[v].x == 1;
    scene.colours.push_back({is_middle ? 1.0 : 0.25, 1, 0.5});
  }
  scene.texcoords = places;
  return scene;
}

const std::vector<Vec2> kWholeEach = {{0, 0}, {1, 0}, {1, 1}, {0, 1},
                                      {0, 0}, {1, 0}, {1, 1}, {0, 1}};

struct Cut {
  double area = 0;
  double patch_area = 0;
  std::size_t triangles = 0;
  std::size_t pieces = 0;
};

/// Cuts all triangles of patches, and calls check(place, middle of the piece, corner) for corners.
template <class Check>
Cut cutAll(const Scene& scene, std::size_t patches, const Check& check) {
  Progress progress;
  const PatchMesh mesh = meshScene(scene, {.patches = patches}, progress).mesh;
  page::TexturePieces pieces(scene, mesh);
  Cut cut;
  for (Index i = 0; i < mesh.size(); ++i) {
    EXPECT_TRUE(pieces.enter(i));
    cut.patch_area += mesh.area[i];
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      std::array<Vec3, 3> at;
      for (std::size_t k = 0; k < 3; ++k) at[k] = mesh.vertices[mesh.pieces[t][k]];
      ++cut.triangles;
      pieces.cut(at, [&](const page::Piece& piece) {
        ++cut.pieces;
        std::array<Vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vec3& w = piece[k].weights;
          p[k] = w.x * at[0] + w.y * at[1] + w.z * at[2];
        }
        const Vec3 turned = glm::cross(p[1] - p[0], p[2] - p[0]);
        EXPECT_GT(turned.z, 0);  // as its patch is
        cut.area += glm::length(turned) / 2;
        for (std::size_t k = 0; k < 3; ++k) check(p[k], (p[0] + p[1] + p[2]) / 3.0, piece[k]);
      });
    }
  }
  return cut;
}

TEST(PageTextures, TrianglesAreCutWhereCoordinatesBreakOff) {
  const Scene scene = twoTiles(kWholeEach);
  // Some of three patches in a row lie in both squares.
  const Cut cut = cutAll(scene, 3, [](const Vec3& p, const Vec3& middle, const auto& corner) {
    const double left = middle.x < 1 ? 0 : 1;
    EXPECT_NEAR(corner.uv.x, p.x - left, 1e-9);
    EXPECT_NEAR(corner.uv.y, p.y, 1e-9);
    EXPECT_NEAR(corner.colour.x, 1 - 0.75 * std::abs(p.x - 1), 1e-9);
    EXPECT_EQ(corner.colour.y, 1);
    EXPECT_EQ(corner.colour.z, 0.5);
  });
  EXPECT_NEAR(cut.area, 2, 1e-9);
  EXPECT_NEAR(cut.patch_area, 2, 1e-9);
  EXPECT_GT(cut.pieces, cut.triangles);
}

TEST(PageTextures, TrianglesStayWholeWhereCoordinatesGoOn) {
  Scene scene = twoTiles({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}, {2, 0}, {2, 1}, {1, 1}});
  scene.colours.clear();
  const Cut cut = cutAll(scene, 3, [](const Vec3& p, const Vec3&, const auto& corner) {
    EXPECT_NEAR(corner.uv.x, p.x, 1e-9);
    EXPECT_EQ(corner.colour, Vec3(1.0));
  });
  EXPECT_EQ(cut.pieces, cut.triangles);
}

TEST(PageTextures, TexelsAreThoseOfTheSceneAndLargeOnesHalved) {
  Scene scene = twoTiles(kWholeEach);
  const std::vector<float> bright = {0.5F, 2.5F, 0, 1, 0.1F, 0.2F};
  scene.textures = {{"unused", 1, 1, {1, 1, 1}, true},
                    {"bright", 1, 2, bright, false},
                    {"large", 3000, 1500, {}, true}};
  // Columns of two texels, 0.2 and 0.4, have the mean 0.3.
  for (int k = 0; k < 3000 * 1500; ++k) {
    for (int b = 0; b < 3; ++b) scene.textures[2].texels.push_back(k % 2 == 0 ? 0.2F : 0.4F);
  }
  scene.materials[0].texture = 2;
  scene.materials[0].emission_texture = 1;
  Progress progress;
  const PatchMesh mesh = meshScene(scene, {.patches = 3}, progress).mesh;
  page::Container container;
  container.header()["materials"] = {{{"name", "floor"}}};
  PageReport report;
  page::addTextures(scene, mesh, container, report);
  EXPECT_EQ(report.textures, 2u);
  EXPECT_EQ(report.halved_textures, 1u);
  EXPECT_EQ(report.texels, 1500u * 750u + 2u);
  const PageReader page(container.bytes());
  EXPECT_EQ(page.header["materials"][0]["texture"], 0);
  EXPECT_EQ(page.header["materials"][0]["emission_texture"], 1);
  EXPECT_EQ(page.header["textures"][0]["width"], 1500);
  EXPECT_EQ(page.header["textures"][0]["repeat"], true);
  EXPECT_EQ(page.header["textures"][1]["scale"], 2.5);
  const auto large = page.array<std::uint8_t>("texture_0");
  ASSERT_EQ(large.size(), 3u * 1500 * 750);
  EXPECT_EQ(large[0], std::lround(255 * srgbFromLinear(0.3)));
  EXPECT_EQ(large[3], 0);  // as the one to its left
  const auto coded = page.array<std::uint8_t>("texture_1");
  ASSERT_EQ(coded.size(), bright.size());
  for (std::size_t k = 0; k < coded.size(); ++k) {
    // Half a step of 8 bits; the curve is at most 2.3 steep in linear light.
    EXPECT_NEAR(2.5 * linearFromSrgb(coded[k] / 255.0), bright[k], 2.5 * 2.3 / 510) << k;
  }
}

}  // namespace
}  // namespace radiosity
