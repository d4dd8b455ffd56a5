// Where rays of an unknown leave: the order of its patches, and the shares of its parts.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "formfactor/rays/origin_order.h"
#include "formfactor/rays/ray_origins.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

std::vector<Index> allOf(const PatchMesh& mesh) {
  std::vector<Index> patches(mesh.size());
  std::iota(patches.begin(), patches.end(), Index(0));
  return patches;
}

std::vector<std::size_t> shuffled(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  return order;
}

/// Rectangles side by side along x, of random widths, in random order.
PatchMesh strip(std::size_t count) {
  test::MeshBuilder builder;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> width(0.1, 3);
  double x = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double w = width(random);
    builder.grid("strip", {x, 0, 0}, {w, 0, 0}, {0, 1, 0});
    x += w;
  }
  return builder.build(shuffled(count));
}

TEST(OriginOrder, FollowsAStripFromEndToEnd) {
  const PatchMesh mesh = strip(37);
  const std::vector<Index> order = originOrder(mesh, allOf(mesh));
  ASSERT_EQ(order.size(), mesh.size());
  for (std::size_t k = 1; k < order.size(); ++k) {
    EXPECT_LT(mesh.centroid[order[k - 1]].x, mesh.centroid[order[k]].x);
  }
}

TEST(OriginOrder, KeepsPatchesThatFaceAlikeTogether) {
  test::MeshBuilder builder;
  builder.box("box", {0, 0, 0}, {1, 1, 1}, 4);
  const PatchMesh mesh = builder.build(shuffled(6 * 16));
  const std::vector<Index> order = originOrder(mesh, allOf(mesh));
  // Halves of halves of a box: no eighth has more than two of its six faces.
  for (std::size_t first = 0; first < order.size(); first += order.size() / 8) {
    std::set<Index> polygons;
    for (std::size_t k = first; k < first + order.size() / 8; ++k) {
      polygons.insert(mesh.polygon[order[k]]);
    }
    EXPECT_LE(polygons.size(), 2U);
  }
}

TEST(OriginOrder, HasEveryPatchOnceAndThoseWithoutAnAreaLast) {
  PatchMesh mesh = strip(20);
  mesh.area[3] = 0;
  mesh.area[11] = 0;
  std::vector<Index> order = originOrder(mesh, allOf(mesh));
  EXPECT_EQ(order[18] + order[19], 14U);
  std::sort(order.begin(), order.end());
  EXPECT_EQ(order, allOf(mesh));
  EXPECT_TRUE(originOrder(mesh, {}).empty());
}

TEST(OriginOrder, OneLargePatchAmongTinyOnes) {
  test::MeshBuilder builder;
  builder.grid("plate", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 60, 60);
  builder.grid("plate", {1, 0, 0}, {1e6, 0, 0}, {0, 1e6, 0});
  const PatchMesh mesh = builder.build();
  const std::vector<Index> order = originOrder(mesh, allOf(mesh));
  EXPECT_EQ(order.back(), 3600U);
}

TEST(RayOrigins, PartsHaveSharesByArea) {
  const PatchMesh mesh = strip(37);
  const RayOrigins origins(mesh, allOf(mesh), 1, Vec3(0.0));
  ASSERT_EQ(origins.parts(), mesh.size());
  constexpr std::size_t kPoints = 1u << 16;
  std::vector<std::size_t> points(origins.parts(), 0);
  float last = 0;
  std::uint32_t last_part = 0;
  for (std::size_t k = 0; k < kPoints; ++k) {
    float within = -1;
    const std::uint32_t part = origins.partAt(float(k) / kPoints, within);
    ASSERT_GE(part, last_part);
    ASSERT_GE(within, part == last_part ? last : 0.0F);
    ASSERT_LT(within, 1.0F);
    ++points[part];
    last = within;
    last_part = part;
  }
  const double sum = std::reduce(mesh.area.begin(), mesh.area.end());
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_NEAR(double(points[p]), mesh.area[p] / sum * kPoints, 1);  // even points: one at most
  }
}

}  // namespace
}  // namespace radiosity
