// Light from the sky: closed forms, the furnace, and an account that balances.
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "formfactor/computed_factors.h"
#include "radiosity/gather.h"
#include "solve_systems.h"
#include "support/quad_mesh.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

constexpr double kPi = std::numbers::pi;

/// About that many patches on the scene.
PatchMesh meshOf(const Scene& scene, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  Progress quiet;
  return meshScene(scene, options, quiet).mesh;
}

Solution solveUnder(const FormFactors& factors, double rho, const std::vector<double>& emission,
                    const std::vector<double>& sky, double tolerance = 1e-12) {
  Progress quiet;
  const std::vector<double> reflectance(emission.size(), rho);
  return solve(factors, reflectance, emission, int(sky.size()),
               test::options(Solver::gauss_seidel, tolerance), quiet, {}, {}, sky);
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

double incoming(const EnergyAccount& e) { return sum(e.emitted) + sum(e.from_sky); }

/// The incoming power that is not accounted for, as a share.
double imbalance(const EnergyAccount& e) {
  EXPECT_NEAR(incoming(e) - sum(e.absorbed) - sum(e.to_sky) - sum(e.on_backs), sum(e.imbalance),
              1e-12 * incoming(e));
  return std::abs(sum(e.imbalance)) / incoming(e);
}

TEST(Sky, AFloorReflectsExactlyRhoPiL) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 3, 2, 0);
  const PatchMesh mesh = meshOf(builder.scene(), 40);
  const FormFactors factors = test::computed(mesh, test::exactly(1e-9));
  const std::vector<double> sky = {1, 0, 2.5};
  const Solution s = solveUnder(factors, 0.3, std::vector<double>(3 * mesh.size(), 0.0), sky);
  ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
  for (std::size_t k = 0; k < s.radiosity.size(); ++k) {
    // Nothing else is in the hemisphere: products of the very numbers, to rounding.
    EXPECT_NEAR(s.irradiance[k], kPi * sky[k % 3], 1e-15 * kPi * 2.5);
    EXPECT_NEAR(s.radiosity[k], 0.3 * kPi * sky[k % 3], 1e-15 * kPi * 2.5);
  }
  EXPECT_NEAR(s.summary.energy.from_sky[2], 6 * kPi * 2.5, 1e-13);  // area of 6 m^2, rounding
  EXPECT_LT(imbalance(s.summary.energy), 1e-14);
}

// Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", C-11: identical, parallel,
// directly opposed rectangles; a unit cube's opposite faces have F = 0.1998248957.
TEST(Sky, AnOpenCubeSeesTheSkyByTheClosedForms) {
  test::SceneBuilder builder;
  const Index surface = builder.surface("box");
  builder.box(surface, {0, 0, 0}, {1, 1, 1}, false);
  Scene& scene = builder.scene();
  scene.corners.resize(scene.corners.size() - 4);  // the top, which is last
  scene.face_offset.pop_back();
  scene.face_surface.pop_back();
  scene.face_element.pop_back();
  const PatchMesh mesh = meshOf(scene, 5);
  ASSERT_EQ(mesh.size(), 5U);
  const FormFactors factors = test::computed(mesh, test::exactly(1e-9));
  const double opposite = 0.199824895698387;
  const double adjacent = (1 - opposite) / 4;
  const Solution s =
      solveUnder(factors, 0.0, std::vector<double>(mesh.size(), 0.0), std::vector<double>{2.0});
  ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const bool floor = std::abs(mesh.normal[i].z) > 0.5;
    // Form factors are stored in 32 bits; the row's four others add up to 1 - F_sky.
    EXPECT_NEAR(s.irradiance[i], 2 * kPi * (floor ? opposite : adjacent), 2 * kPi * 5e-7);
    EXPECT_EQ(s.radiosity[i], 0) << "black walls send nothing back";
  }
  EXPECT_LT(imbalance(s.summary.energy), 1e-6);
}

// A convex scene in a sky of radiance L whose walls emit (1 - rho) pi L: radiance is L everywhere.
TEST(Sky, AnOpenBoxUnderAMatchingSkyIsAFurnace) {
  test::SceneBuilder builder;
  builder.prism(builder.surface("box"), {{0, 0}, {2, 0}, {2.5, 1.5}, {0, 1}}, 0, 1, false);
  Scene scene = test::turned(builder.scene());
  scene.corners.resize(scene.corners.size() - 4);
  scene.face_offset.pop_back();
  scene.face_surface.pop_back();
  scene.face_element.pop_back();
  const PatchMesh mesh = meshOf(scene, 60);
  const FormFactors factors = test::computed(mesh, test::exactly(1e-9));
  for (const double rho : {0.1, 0.5, 0.95}) {
    const std::vector<double> emission(mesh.size(), (1 - rho) * kPi);
    const Solution s = solveUnder(factors, rho, emission, {1.0});
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    for (const double b : s.radiosity) {
      // The rows' accounts sum to 1 exactly: the sky takes what fronts leave. Sums of 60 terms.
      EXPECT_NEAR(b, kPi, 1e-10) << rho;
    }
    EXPECT_LT(imbalance(s.summary.energy), 1e-6) << "32-bit form factors";
  }
}

TEST(Sky, TheAccountBalancesIfFIsReciprocal) {
  test::Random random(11);
  const std::size_t n = 50;
  const auto [f, area] = test::reciprocal(n, random);
  const auto factors = test::factorsFrom(f, area, 0.25);
  Progress quiet;
  const auto rho = random.vector(3 * n, 0.0, 0.9);
  const auto emission = random.vector(3 * n, 0.0, 2.0);
  for (const Solver solver : test::kSolvers) {
    const Solution s = solve(factors, rho, emission, 3, test::options(solver, 1e-13), quiet, {}, {},
                             std::vector<double>{1, 10, 0});
    ASSERT_EQ(s.summary.status, SolveStatus::converged) << s.summary.message;
    EXPECT_LT(imbalance(s.summary.energy), 1e-11);  // the residual, summed
    EXPECT_GT(s.summary.energy.from_sky[1], s.summary.energy.from_sky[0]);
    EXPECT_EQ(s.summary.energy.from_sky[2], 0);
  }
}

TEST(Sky, AClosedSceneStaysDark) {
  const auto factors = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  auto closed = factors;
  closed.sky.assign(6, 0.0);
  const Solution s = solveUnder(closed, 0.5, std::vector<double>(6, 0.0), {1.0});
  EXPECT_EQ(s.summary.status, SolveStatus::no_light);
}

TEST(Sky, RefusesInvalidRadiances) {
  const auto factors = test::factorsFrom(test::cube(), std::vector<double>(6, 1.0));
  const std::vector<double> dark(6, 0.0);
  EXPECT_THROW(solveUnder(factors, 0.5, dark, {-1.0}), InputError);
  EXPECT_THROW(solveUnder(factors, 0.5, dark, {NAN}), InputError);
  Progress quiet;
  EXPECT_THROW(solve(factors, dark, dark, 1, {}, quiet, {}, {}, std::vector<double>{1, 1}),
               InputError);
}

// The gather method's eyes see the same sky.
TEST(Sky, GatheredLightOfAFloorIsRhoPiL) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 1, 1, 0);
  const PatchMesh mesh = meshOf(builder.scene(), 9);
  const PatchMaterials materials{3,
                                 std::vector<double>(3 * mesh.size(), 0.25),
                                 std::vector<double>(3 * mesh.size(), 0.0),
                                 {uniformSky({2, 0, 1})}};
  for (const GatherAt at : {GatherAt::patches, GatherAt::vertices}) {
    GatherOptions options;
    options.at = at;
    options.resolution = 64;
    Progress quiet;
    const Gathered g = gather(mesh, materials, options, quiet);
    EXPECT_EQ(int(g.summary.status), int(GatherStatus::converged)) << g.summary.message;
    for (std::size_t k = 0; k < g.radiosity.size(); ++k) {
      // 32-bit floats.
      EXPECT_NEAR(g.radiosity[k], 0.25 * kPi * materials.lights[0].strength[k % 3], 1e-6);
    }
    // The one pass leaves the floor's reflected light in flight.
    const GatherPass& last = g.summary.passes.back();
    EXPECT_LT(std::abs(sum(last.energy.imbalance)), 1e-6 * incoming(last.energy));
    EXPECT_NEAR(sum(last.in_flight), 0.25 * kPi * 3, 1e-6);
  }
}

}  // namespace
}  // namespace radiosity
