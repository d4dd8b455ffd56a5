// Where rays of a patch leave: the shares of its parts.
#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

#include "formfactor/rays/ray_origins.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

/// A patch of triangles with one corner in common, side by side along x, of random widths.
PatchMesh fan(std::size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> width(0.1, 3);
  std::vector<Vec3> outline{{0, 1, 0}, {0, 0, 0}};
  for (std::size_t k = 0; k < count; ++k) {
    outline.push_back(outline.back() + Vec3(width(random), 0, 0));
  }
  test::MeshBuilder builder;
  builder.polygon("fan", {outline});
  return builder.build();
}

TEST(RayOrigins, PartsHaveSharesByArea) {
  const PatchMesh mesh = fan(37);
  const RayOrigins origins(mesh, 0, 1, Vec3(0.0));
  ASSERT_EQ(origins.parts(), 37U);
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
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double width = mesh.vertices[mesh.pieces[p][2]].x - mesh.vertices[mesh.pieces[p][1]].x;
    // Even points: one at most.
    EXPECT_NEAR(double(points[p]), 0.5 * width / mesh.area[0] * kPoints, 1);
  }
}

TEST(RayOrigins, ADegeneratePatchHasNone) {
  PatchMesh mesh = fan(3);
  mesh.area[0] = 0;
  EXPECT_TRUE(RayOrigins(mesh, 0, 1, Vec3(0.0)).empty());
}

}  // namespace
}  // namespace radiosity
