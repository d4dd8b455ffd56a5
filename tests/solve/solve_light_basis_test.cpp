// Lamps solved one by one add up to all of them solved together.
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/light_basis.h"
#include "solve_systems.h"
#include "support/error_of.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

/// A room with two lamps and a skylight, under a sky.
class LightBasisTest : public ::testing::Test {
 protected:
  LightBasisTest() {
    test::SceneBuilder builder;
    const double w = 4, d = 3, h = 2.5;
    const Index wall = builder.surface("wall", 0.7);
    const Index lamp = builder.surface("lamp", 0.2, 30);
    const Index window = builder.surface("window", 0.1, 5);
    builder.face(wall, {{0, 0, 0}, {w, 0, 0}, {w, d, 0}, {0, d, 0}});
    builder.face(wall, {{0, 0, h}, {0, d, h}, {w / 2, d, h}, {w / 2, 0, h}});  // half open
    builder.face(lamp, {{0, 0, 0}, {0, d, 0}, {0, d, h}, {0, 0, h}});
    builder.face(wall, {{w, 0, 0}, {w, 0, h}, {w, d, h}, {w, d, 0}});
    builder.face(wall, {{0, 0, 0}, {0, 0, h}, {w, 0, h}, {w, 0, 0}});
    builder.face(window, {{0, d, 0}, {w, d, 0}, {w, d, h}, {0, d, h}});
    builder.scene().lights = {uniformSky({1, 2, 3})};
    MeshOptions options;
    options.patches = 400;
    mesh = meshScene(builder.scene(), options, quiet).mesh;
    materials = patchMaterials(builder.scene(), mesh);
    factors = computeFormFactors(mesh, {}, quiet);
  }

  Progress quiet;
  PatchMesh mesh;
  PatchMaterials materials;
  FormFactors factors;
};

TEST_F(LightBasisTest, MixturesEqualFullSolutions) {
  const std::vector<LightSource> sources = lightSources(materials, mesh);
  ASSERT_EQ(sources.size(), 3u);
  const SolveOptions options = test::options(Solver::cg, 1e-9);
  const LightBasis basis = solveBasis(factors, materials, mesh, sources, options, quiet);
  EXPECT_EQ(basis.names, (std::vector<std::string>{sources[0].name, sources[1].name, "sky"}));
  ASSERT_EQ(basis.solution.summary.status, SolveStatus::converged);
  for (const std::vector<double>& weights :
       {std::vector<double>{1, 1, 1}, {2, 0.5, 0}, {0, 0, 3}, {0.1, 10, 1}}) {
    PatchMaterials full = materials;
    for (std::size_t k = 0; k < full.emission.size(); ++k) {
      full.emission[k] = weights[0] * sources[0].emission[k] + weights[1] * sources[1].emission[k];
    }
    for (double& radiance : full.lights[0].strength) radiance *= weights[2];
    const Solution expected = solve(factors, full, mesh, options, quiet);
    ASSERT_EQ(expected.summary.status, SolveStatus::converged);
    const std::vector<LightWeight> mix = {
        {basis.names[0], weights[0]}, {basis.names[1], weights[1]}, {"sky", weights[2]}};
    const MixedLight mixed = mixLight(basis, mix);
    const double bound = *mixed.solution.summary.error_bound + *expected.summary.error_bound;
    EXPECT_LT(bound, 1e-5);
    EXPECT_LE(test::largestDifference(mixed.solution.radiosity, expected.radiosity), bound);
    EXPECT_LE(test::largestDifference(mixed.solution.irradiance, expected.irradiance), bound);
    EXPECT_EQ(mixed.materials.reflectance, materials.reflectance);
    EXPECT_LT(test::largestDifference(mixed.materials.emission, full.emission), 1e-12);
    EXPECT_EQ(mixed.materials.lights[0].strength, full.lights[0].strength);
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(mixed.solution.summary.energy.absorbed[b], expected.summary.energy.absorbed[b],
                  1e-6 * expected.summary.energy.absorbed[b]);
    }
  }
}

// As many products for three sources as for one: they share each.
TEST_F(LightBasisTest, TakesNoMoreProductsThanTheHardestSource) {
  const std::vector<LightSource> sources = lightSources(materials, mesh);
  const SolveOptions options = test::options(Solver::cg, 1e-6);
  int most = 0;
  for (const LightSource& source : sources) {
    const LightBasis one = solveBasis(factors, materials, mesh, {&source, 1}, options, quiet);
    most = std::max(most, one.solution.summary.iterations);
  }
  const LightBasis all = solveBasis(factors, materials, mesh, sources, options, quiet);
  EXPECT_LE(all.solution.summary.iterations, most + 1);  // bands that wait may begin a cycle anew
}

TEST_F(LightBasisTest, RefusesUnknownRepeatedAndMissingSources) {
  const std::vector<LightSource> sources = lightSources(materials, mesh);
  const LightBasis basis = solveBasis(factors, materials, mesh, sources, {}, quiet);
  const auto refusal = [&](const std::vector<LightWeight>& mix) {
    return test::errorOf([&] { mixLight(basis, mix); });
  };
  EXPECT_NE(refusal({{"lantern", 1}}).find("there is no light 'lantern'; there are lamp"),
            std::string::npos);
  EXPECT_NE(refusal({{"sky", 1}, {"sky", 2}}).find("given twice"), std::string::npos);
  EXPECT_NE(refusal({{"sky", -1}}).find("finite factor >= 0"), std::string::npos);
  const std::vector<LightSource> same = {sources[0], sources[0]};
  EXPECT_NE(test::errorOf([&] {
              solveBasis(factors, materials, mesh, same, {}, quiet);
            }).find("two are called"),
            std::string::npos);
  EXPECT_NE(test::errorOf([&] {
              solveBasis(factors, materials, mesh, {}, {}, quiet);
            }).find("there is none"),
            std::string::npos);
}

TEST_F(LightBasisTest, AnEmptyMixIsDark) {
  const LightBasis basis =
      solveBasis(factors, materials, mesh, lightSources(materials, mesh), {}, quiet);
  const MixedLight dark = mixLight(basis, {});
  EXPECT_EQ(dark.solution.radiosity, std::vector<double>(materials.emission.size(), 0.0));
  EXPECT_NE(dark.solution.summary.message.find("no light"), std::string::npos);
}

}  // namespace
}  // namespace radiosity
