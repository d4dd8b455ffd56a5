// Light between clusters of patches against light between the patches themselves: the same form
// factors, summed over clusters, must give every surface the same power.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "formfactor/cluster_factors.h"
#include "mesh/clusters/cluster_means.h"
#include "radiosity/matrix_functions.h"
#include "radiosity/solve.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

/// A body of revolution about the vertical axis at `centre`: `profile` from bottom to top, radius
/// and height; fronts outward.
void turnedBody(SceneBuilder& builder, Index surface, const Vec3& centre,
                const std::vector<Vec2>& profile, std::size_t around, bool outward = true) {
  const auto point = [&](const Vec2& p, std::size_t k) {
    const double a = 2 * std::numbers::pi * double(k % around) / double(around);
    return centre + Vec3(p.x * std::cos(a), p.x * std::sin(a), p.y);
  };
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    for (std::size_t k = 0; k < around; ++k) {
      std::vector<Vec3> face{point(profile[ring], k), point(profile[ring], k + 1),
                             point(profile[ring + 1], k + 1), point(profile[ring + 1], k)};
      if (profile[ring].x == 0) face.erase(face.begin());
      if (profile[ring + 1].x == 0) face.pop_back();
      if (!outward) std::reverse(face.begin(), face.end());
      builder.face(surface, face);
    }
  }
}

std::vector<Vec2> arc(double radius, double from, double to, std::size_t steps) {
  std::vector<Vec2> out;
  for (std::size_t k = 0; k <= steps; ++k) {
    const double a = std::numbers::pi * (from + (to - from) * double(k) / double(steps));
    const double r = radius * std::cos(a);
    out.emplace_back(std::abs(r) < 1e-9 * radius ? 0.0 : r, radius * std::sin(a));
  }
  return out;
}

void room(SceneBuilder& builder, double width, double depth, double height) {
  const auto wall = [&](const char* name, double reflectance, const std::vector<Vec3>& corners) {
    builder.face(builder.surface(name, reflectance), corners);
  };
  wall("floor", 0.3, {{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}});
  wall("ceiling", 0.8,
       {{0, 0, height}, {0, depth, height}, {width, depth, height}, {width, 0, height}});
  wall("left", 0.6, {{0, 0, 0}, {0, depth, 0}, {0, depth, height}, {0, 0, height}});
  wall("right", 0.6,
       {{width, 0, 0}, {width, 0, height}, {width, depth, height}, {width, depth, 0}});
  wall("near", 0.5, {{0, 0, 0}, {0, 0, height}, {width, 0, height}, {width, 0, 0}});
  wall("far", 0.5, {{0, depth, 0}, {width, depth, 0}, {width, depth, height}, {0, depth, height}});
}

/// A ball and a vase in a room under a lamp.
Scene ballAndVase() {
  SceneBuilder builder;
  room(builder, 4, 3, 2.5);
  turnedBody(builder, builder.surface("ball", 0.7), {1.2, 1, 0.7}, arc(0.5, -0.5, 0.5, 12), 24);
  turnedBody(builder, builder.surface("vase", 0.4), {2.8, 2, 0.2},
             {{0, 0},
              {0.2, 0},
              {0.3, 0.2},
              {0.35, 0.4},
              {0.3, 0.6},
              {0.15, 0.8},
              {0.2, 1},
              {0.25, 1.05},
              {0, 1.05}},
             24);
  builder.level(builder.surface("lamp", 0.1, 30), 1.7, 1.2, 2.3, 1.8, 2.4, false);
  return builder.scene();
}

/// A bowl under a lamp under the open sky: it sees itself.
Scene bowl() {
  SceneBuilder builder;
  turnedBody(builder, builder.surface("bowl", 0.8), {0, 0, 0}, arc(1, -0.5, 0, 16), 48, false);
  builder.level(builder.surface("lamp", 0.0, 10), -0.4, -0.2, 0.3, 0.4, 0.5, false);
  return builder.scene();
}

/// Hills lit by a lamp above them.
Scene hills() {
  SceneBuilder builder;
  const Index ground = builder.surface("ground", 0.6);
  constexpr int kSteps = 30;
  const auto point = [&](int i, int j) {
    const double x = 10.0 * i / kSteps;
    const double y = 10.0 * j / kSteps;
    return Vec3(x, y, std::sin(1.3 * x) * std::cos(0.9 * y) + 0.3 * std::sin(3.1 * x + 2 * y));
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      builder.face(ground, {point(i, j), point(i + 1, j), point(i + 1, j + 1)});
      builder.face(ground, {point(i, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  builder.level(builder.surface("lamp", 0.2, 50), 3, 3, 5, 5, 3, false);
  return builder.scene();
}

/// A hall with two rows of columns and a barrel vault.
Scene vault() {
  SceneBuilder builder;
  const Index stone = builder.surface("vault", 0.5);
  const double radius = 2;
  constexpr int kAround = 32;
  const auto rim = [&](int k, double y) {
    const double a = std::numbers::pi * k / kAround;
    return Vec3(2 - radius * std::cos(a), y, 2.5 + radius * std::sin(a));
  };
  constexpr int kAlong = 10;
  for (int k = 0; k < kAround; ++k) {
    for (int l = 0; l < kAlong; ++l) {
      builder.face(stone, {rim(k, 0.8 * l), rim(k, 0.8 * (l + 1)), rim(k + 1, 0.8 * (l + 1)),
                           rim(k + 1, 0.8 * l)});
    }
  }
  builder.face(builder.surface("floor", 0.3), {{0, 0, 0}, {4, 0, 0}, {4, 8, 0}, {0, 8, 0}});
  builder.face(builder.surface("left", 0.6), {{0, 0, 0}, {0, 8, 0}, {0, 8, 2.5}, {0, 0, 2.5}});
  builder.face(builder.surface("right", 0.6), {{4, 0, 0}, {4, 0, 2.5}, {4, 8, 2.5}, {4, 8, 0}});
  const Index columns = builder.surface("columns", 0.7);
  for (int k = 0; k < 3; ++k) {
    for (const double x : {1.0, 3.0}) {
      builder.prism(columns, SceneBuilder::regularPolygon({x, 2.0 + 2 * k}, 0.2, 16), 0, 2.5);
    }
  }
  builder.box(builder.surface("lamp", 0.1, 20), {1.8, 3, 2}, {2.2, 5, 2.1});
  return builder.scene();
}

/// Form factors between all patches of a mesh that has clusters.
FormFactors factorsOfPatches(PatchMesh mesh, FormFactorMethod method) {
  mesh.clusters.reset();
  FormFactorOptions options;
  options.method = method;
  // Both solutions have the same form factors; rays find the light within clusters.
  options.tolerance = method == FormFactorMethod::rays ? 0.02 : 0.1;
  options.resolution = 128;
  options.symmetrize = true;
  options.precision = Precision::double_precision;
  Progress progress;
  return computeFormFactors(mesh, options, progress);
}

PatchMesh meshed(const Scene& scene, std::size_t patches) {
  Progress progress;
  MeshOptions options;
  options.patches = patches;
  return meshScene(scene, options, progress).mesh;
}

Solution solved(const FormFactors& factors, const PatchMaterials& materials,
                const PatchMesh& mesh) {
  Progress progress;
  return solve(factors, materials, mesh, {}, progress);
}

/// The power of each surface, red, W.
std::vector<double> powers(const PatchMesh& mesh, const Solution& solution) {
  std::vector<double> power(mesh.surface_names.size(), 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    power[mesh.surface[i]] += mesh.area[i] * solution.radiosity[3 * i];
  }
  return power;
}

struct Named {
  const char* name;
  Scene (*scene)();
  std::size_t patches;
  FormFactorMethod method;
  double tolerance;
};

class SolveClusters : public testing::TestWithParam<Named> {};

TEST_P(SolveClusters, GivesEverySurfaceThePowerOfItsPatches) {
  const auto& [name, scene, patches, method, tolerance] = GetParam();
  const Scene given = scene();
  const PatchMesh mesh = meshed(given, patches);
  ASSERT_TRUE(mesh.clusters) << mesh.size();
  ASSERT_GT(double(mesh.size()), 1.5 * double(mesh.unknowns()));
  const FormFactors factors = factorsOfPatches(mesh, method);
  const PatchMaterials materials = patchMaterials(given, mesh);
  PatchMesh apart = mesh;
  apart.clusters.reset();
  Progress progress;
  const auto expected = powers(mesh, solved(factors, materials, apart));
  const Solution solution = solved(clusterFactors(factors, mesh, progress), materials, mesh);
  EXPECT_EQ(solution.summary.status, SolveStatus::converged);
  ASSERT_EQ(solution.radiosity.size(), 3 * mesh.size());
  const auto power = powers(mesh, solution);
  for (std::size_t s = 0; s < power.size(); ++s) {
    EXPECT_NEAR(power[s], expected[s], tolerance * expected[s]) << mesh.surface_names[s];
  }
}

Scene curved() { return loadScene(RADIOSITY_SOURCE_DIR "/data/curved.obj"); }
Scene furnished() { return loadScene(RADIOSITY_SOURCE_DIR "/data/furnished-room.obj"); }

constexpr auto kExact = FormFactorMethod::exact;
constexpr auto kHemicube = FormFactorMethod::hemicube;
constexpr auto kRays = FormFactorMethod::rays;

// Clusters may cost 1% of a surface's power. The furnished room is the hard one: it joins sides of
// books that are alike in place and direction, but some lie open to the room and others deep
// between books. Hemicubes, an eye a patch, do not see the same there as rays from all over it.
INSTANTIATE_TEST_SUITE_P(Scenes, SolveClusters,
                         testing::Values(Named{"BallAndVase", ballAndVase, 150, kExact, 0.01},
                                         Named{"Bowl", bowl, 150, kExact, 0.01},
                                         Named{"Hills", hills, 300, kHemicube, 0.01},
                                         Named{"Vault", vault, 60, kExact, 0.01},
                                         Named{"Curved", curved, 250, kHemicube, 0.01},
                                         Named{"Furnished", furnished, 2000, kRays, 0.01}),
                         [](const auto& scene) { return std::string(scene.param.name); });

TEST(ClusterFactors, EqualComputeFormFactorsOfAMeshWithClusters) {
  const PatchMesh mesh = meshed(vault(), 60);
  ASSERT_TRUE(mesh.clusters);
  const FormFactors of_patches = factorsOfPatches(mesh, kHemicube);
  FormFactorOptions options;
  options.method = kHemicube;
  options.resolution = 128;
  options.symmetrize = true;
  options.precision = Precision::double_precision;
  Progress progress;
  const FormFactors factors = computeFormFactors(mesh, options, progress);
  ASSERT_EQ(factors.matrix->size(), mesh.unknowns());
  EXPECT_TRUE(factors.matrix->isSymmetric());
  const FormFactors expected = clusterFactors(of_patches, mesh, progress);
  EXPECT_EQ(factors.fronts, expected.fronts);
  EXPECT_EQ(factors.backs, expected.backs);
  EXPECT_EQ(factors.sky, expected.sky);
  const std::vector<double> sums = factors.matrix->rowSums();
  for (std::size_t c = 0; c < mesh.unknowns(); ++c) {
    // Closed to 1e-12 as rows of patches, then summed over 16 patches and 60 clusters.
    EXPECT_NEAR(sums[c], factors.fronts[c], 1e-11);
    // Accounts of hemicubes sum to 1 but for rounding of 50,000 pixels.
    EXPECT_NEAR(factors.fronts[c] + factors.backs[c] + factors.sky[c], 1, 1e-11);
  }
}

TEST(ClusterFactors, HaveErrorFiguresThatBoundTheErrorsOfPatches) {
  // Rows of patches that are off by the same in every entry, with the same sign: the worst case for
  // sums over clusters.
  const PatchMesh mesh = meshed(vault(), 60);
  const std::size_t n = mesh.size();
  const auto matrixOf = [&](double error) {
    auto matrix = std::make_shared<RowMatrix>(mesh.area, Precision::double_precision);
    std::vector<Index> columns(n);
    std::iota(columns.begin(), columns.end(), Index(0));
    for (std::size_t i = 0; i < n; ++i) {
      matrix->setRow(i, columns, std::vector<double>(n, 0.5 / double(n) + error));
    }
    return matrix;
  };
  const double error = 1e-4;
  FormFactors wrong;
  wrong.matrix = matrixOf(error);
  wrong.error.assign(n, error * std::sqrt(double(n)));
  Progress progress;
  const FormFactors off = clusterFactors(wrong, mesh, progress);
  const auto truth = aggregated(*matrixOf(0), mesh.clusters->of_patch, mesh.unknowns(), progress);
  ASSERT_EQ(off.error.size(), mesh.unknowns());
  for (std::size_t c = 0; c < mesh.unknowns(); ++c) {
    double square = 0;
    for (std::size_t other = 0; other < mesh.unknowns(); ++other) {
      square += std::pow(off.matrix->at(c, other) - truth->at(c, other), 2);
    }
    EXPECT_LE(std::sqrt(square), off.error[c]);
  }
}

double squaredDistance(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus<>(),
                            [](double x, double y) { return (x - y) * (x - y); });
}

TEST(SolveWithClusters, KeepsEachPatchsOwnReflectanceAndEmission) {
  const Scene scene = vault();
  const PatchMesh mesh = meshed(scene, 60);
  PatchMaterials materials = patchMaterials(scene, mesh);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t b = 0; b < 3; ++b) {
      materials.reflectance[3 * i + b] *= i % 3 == 0 ? 0.5 : 1.0;
      if (i % 2 == 0) materials.emission[3 * i + b] *= 2;
    }
  }
  Progress progress;
  const FormFactors of_patches = factorsOfPatches(mesh, kHemicube);
  const FormFactors factors = clusterFactors(of_patches, mesh, progress);
  const Solution solution = solved(factors, materials, mesh);
  const Solution of_clusters =
      solve(factors, clusterMeans(mesh, materials.reflectance, 3),
            clusterMeans(mesh, materials.emission, 3), 3, SolveOptions(), progress);
  PatchMesh apart = mesh;
  apart.clusters.reset();
  // Nearer to the light between patches than means of clusters alone.
  const auto expected = clusterMeans(mesh, solved(of_patches, materials, apart).irradiance, 3);
  const auto means = clusterMeans(mesh, solution.irradiance, 3);
  EXPECT_LT(squaredDistance(means, expected),
            0.25 * squaredDistance(of_clusters.irradiance, expected));
  double emitted = 0;
  double absorbed = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_EQ(
        solution.radiosity[3 * i],
        materials.emission[3 * i] + materials.reflectance[3 * i] * solution.irradiance[3 * i]);
    emitted += mesh.area[i] * materials.emission[3 * i];
    absorbed += mesh.area[i] * (1 - materials.reflectance[3 * i]) * solution.irradiance[3 * i];
  }
  // Means by area: clusters emit as much as their patches. Rounding.
  EXPECT_NEAR(solution.summary.energy.emitted[0], emitted, 1e-12 * emitted);
  // Absorption follows the mean reflectance: some patches of a cluster are lit more than others,
  // and not all reflect alike.
  EXPECT_NEAR(solution.summary.energy.absorbed[0], absorbed, 1e-2 * absorbed);
}

TEST(SolveWithClusters, NamesThePatchWhoseMaterialIsWrong) {
  const Scene scene = vault();
  const PatchMesh mesh = meshed(scene, 60);
  Progress progress;
  const FormFactors factors = clusterFactors(factorsOfPatches(mesh, kHemicube), mesh, progress);
  PatchMaterials materials = patchMaterials(scene, mesh);
  materials.reflectance[3 * 100] = 1.5;  // its cluster's mean may well be below 1
  try {
    solved(factors, materials, mesh);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("patch 100 of surface"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace radiosity
