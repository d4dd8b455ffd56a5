// Light of lamps without a surface, reflected.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formfactor/computed_factors.h"
#include "radiosity/gather.h"
#include "radiosity/light_basis.h"
#include "solve_systems.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

PatchMesh meshOfLamps(const Scene& scene, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  Progress quiet;
  return meshScene(scene, options, quiet).mesh;
}

Scene cubeWithLamp(double rho, const std::vector<std::string>& lights) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room", rho), Vec3(-2.0), Vec3(2.0), false);
  Scene scene = builder.scene();
  for (const std::string& text : lights) addLight(scene.lights, lightOf(text));
  return scene;
}

// CIE 171:2006, case 5.8: a room of 4 m with an isotropic lamp of 10,000 lm in its middle. The mean
// indirect illuminance is Phi rho / (S (1 - rho)), lx.
TEST(Lamps, ACubeHasItsInterreflections) {
  const std::pair<double, double> table[] = {
      {.05, 5.48},  {.1, 11.57},  {.2, 26.04},  {.3, 44.64}, {.4, 69.44},   {.5, 104.17},
      {.6, 156.25}, {.7, 243.06}, {.8, 416.67}, {.9, 937.5}, {.95, 1979.17}};
  const PatchMesh mesh = meshOfLamps(cubeWithLamp(.5, {}), 96);
  const FormFactors factors = test::computed(mesh, test::exactly(1e-7));
  for (const auto& [rho, lux] : table) {
    const PatchMaterials materials = patchMaterials(cubeWithLamp(rho, {"point,10000lm"}), mesh);
    Progress quiet;
    const Solution s = solve(factors, materials, mesh, {.tolerance = 1e-9}, quiet);
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    double flux = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) flux += mesh.area[i] * s.irradiance[3 * i];
    const double indirect = (flux - 10000 / kLumensPerWatt) * kLumensPerWatt / 96;
    // The table has two decimals. 1 / (1 - rho)^2 of the form factors' 1e-7.
    EXPECT_NEAR(indirect, lux, 0.006 + 1e-7 * lux * 20) << rho;
    EXPECT_NEAR(s.summary.energy.from_sky[0], 10000 / kLumensPerWatt, 1e-11);
    EXPECT_NEAR(s.summary.energy.imbalance[0], 0, 1e-4 * s.summary.energy.from_sky[0]);
  }
}

TEST(Lamps, AddUp) {
  const std::vector<std::string> lamps{"point,3,at=1,1,1,name=a", "point,5,at=-1,0,0,name=b",
                                       "spot,2,at=0,0,1,aim=0,0,0"};
  const PatchMesh mesh = meshOfLamps(cubeWithLamp(.5, {}), 96);
  const FormFactors factors = test::computed(mesh, test::exactly(1e-6));
  const PatchMaterials materials = patchMaterials(cubeWithLamp(.5, lamps), mesh);
  Progress quiet;
  const SolveOptions options{.tolerance = 1e-10};
  const Solution together = solve(factors, materials, mesh, options, quiet);
  const std::vector<LightSource> sources = lightSources(materials, mesh);
  ASSERT_EQ(sources.size(), 3u);
  const LightBasis basis = solveBasis(factors, materials, mesh, sources, options, quiet);
  const MixedLight mix = mixLight(basis, std::vector<LightWeight>{{"a", 1}, {"b", 1}, {"spot", 1}});
  for (std::size_t k = 0; k < together.radiosity.size(); ++k) {
    EXPECT_NEAR(mix.solution.radiosity[k], together.radiosity[k], 1e-8 * together.radiosity[k]);
  }
}

// Gathering without a matrix: the same light, but for its hemicubes and its points in the middle.
TEST(Lamps, AreGatheredAsTheyAreSolved) {
  const PatchMesh mesh = meshOfLamps(cubeWithLamp(.5, {}), 600);
  const PatchMaterials materials = patchMaterials(cubeWithLamp(.5, {"point,3,at=.3,.2,0"}), mesh);
  Progress quiet;
  const Solution solved =
      solve(test::computed(mesh, test::exactly(1e-5)), materials, mesh, {}, quiet);
  GatherOptions options;
  options.at = GatherAt::patches;
  options.resolution = 128;
  options.passes = 40;
  const Gathered gathered = gather(mesh, materials, options, quiet);
  double off = 0;
  double whole = 0;
  for (std::size_t k = 0; k < solved.radiosity.size(); ++k) {
    const double difference = gathered.radiosity[k] - solved.radiosity[k];
    off += mesh.area[k / 3] * difference * difference;
    whole += mesh.area[k / 3] * solved.radiosity[k] * solved.radiosity[k];
  }
  // Patches of .4 m: their middles stand for them to (size / distance)^2 / 24, hemicubes to 1%.
  EXPECT_LT(std::sqrt(off / whole), 0.01);
}

TEST(Lamps, ThatReachNothingLeaveItDark) {
  test::SceneBuilder builder;
  builder.box(builder.surface("block"), Vec3(-1.0), Vec3(1.0));
  Scene scene = builder.scene();
  addLight(scene.lights, lightOf("point,1"));
  const PatchMesh mesh = meshOfLamps(scene, 24);
  Progress quiet;
  const Solution s = solve(test::computed(mesh, test::exactly(1e-3)), patchMaterials(scene, mesh),
                           mesh, {}, quiet);
  EXPECT_EQ(s.summary.status, SolveStatus::no_light) << s.summary.message;
}

}  // namespace
}  // namespace radiosity
