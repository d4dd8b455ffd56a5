// The forecast of `rays` against the rays that are cast.
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "formfactor/computed_factors.h"
#include "formfactor/exact_scenes.h"
#include "formfactor/rays/ray_factors.h"
#include "formfactor/rays/ray_scene.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

/// A floor with a low wall at its edge: the rows near the edge take most of the rays.
test::MeshBuilder floorAndWall(int n) {
  test::MeshBuilder builder;
  builder.grid("floor", Vec3(0), Vec3(6, 0, 0), Vec3(0, 6, 0), n, n);
  builder.grid("wall", Vec3(0), Vec3(0, 6, 0), Vec3(0, 0, 0.3), n, 2);
  return builder;
}

/// The same above a plain of four patches, which has most of the area and sees next to nothing.
PatchMesh aboveAPlain() {
  test::MeshBuilder builder = floorAndWall(25);
  builder.grid("plain", Vec3(-12, -12, -1), Vec3(30, 0, 0), Vec3(0, 30, 0), 2, 2);
  return builder.build();
}

/// Counted rays over those foreseen, for one seed.
double countedOverForeseen(const PatchMesh& mesh, double tolerance, std::uint64_t seed) {
  FormFactorOptions options;
  options.method = FormFactorMethod::rays;
  options.tolerance = tolerance;
  options.seed = seed;
  Progress silent;
  const auto counted = double(computeFormFactors(mesh, options, silent).report.rays.rays);
  return counted / estimateRays(RayScene(mesh, seed), options, silent).rays;
}

// Counted rays of these meshes were .91 to 1.25 times those foreseen, to 2e-2 and to 3e-2.
TEST(RayEstimate, RaysAreForeseenWithinAHalf) {
  const std::vector<std::pair<const char*, PatchMesh>> meshes = {
      {"two rooms", test::meshOf(test::dataScene("two-rooms"), 500)},
      {"curved", test::meshOf(test::dataScene("curved"), 1500)},
      {"floor and wall", floorAndWall(40).build()},
      {"above a plain", aboveAPlain()}};
  for (const auto& [name, mesh] : meshes) {
    for (const std::uint64_t seed : {1, 2}) {
      const double ratio = countedOverForeseen(mesh, 3e-2, seed);
      EXPECT_LT(ratio, 1.5) << name << ", seed " << seed;
      EXPECT_GT(ratio, 1 / 1.5) << name << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace radiosity
