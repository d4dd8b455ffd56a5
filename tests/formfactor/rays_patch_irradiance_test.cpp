// The irradiance of patches that share an unknown.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "formfactor/patch_irradiance.h"
#include "formfactor/rays/seen_patches.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using std::numbers::pi;

/// Of patches whose clusters have these values, K * bands.
std::vector<double> patchIrradiance(const PatchMesh& mesh, std::span<const double> radiosity,
                                    std::span<const double> irradiance, int bands,
                                    std::span<const double> sky, Progress& progress) {
  PatchIrradiance within(mesh, bands, sky);
  std::vector<double> of_patches;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto first = radiosity.begin() + std::ptrdiff_t(mesh.unknownOf(i)) * bands;
    of_patches.insert(of_patches.end(), first, first + bands);
  }
  within.look(of_patches, progress);
  return within.around(irradiance);
}

/// One unknown for the patches of the first surface, one for each other patch.
void shareFirstSurface(PatchMesh& mesh) {
  PatchClusters clusters;
  clusters.begin.push_back(0);
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.surface[i] != 0 || i == 0) {
      if (i > 0) clusters.begin.push_back(i);
    }
    clusters.patches.push_back(i);
    clusters.of_patch.push_back(Index(clusters.begin.size() - 1));
  }
  clusters.begin.push_back(mesh.size());
  mesh.clusters = clusters;
}

/// A strip that bends from level to 75 degrees, like a piece of a cylinder, high above black
/// ground.
PatchMesh bentStrip() {
  constexpr int kPieces = 6;
  test::MeshBuilder builder;
  const auto at = [](int k) {
    const double angle = k * pi / 12;
    return Vec3(std::sin(angle), 0, 2 + std::cos(angle));
  };
  for (int k = 0; k < kPieces - 1; ++k) {
    builder.grid("strip", at(k), at(k + 1) - at(k), {0, 1, 0});
  }
  builder.grid("ground", {-5000, -5000, 0}, {10000, 0, 0}, {0, 10000, 0});
  PatchMesh mesh = builder.build();
  shareFirstSurface(mesh);
  return mesh;
}

TEST(PatchIrradiance, FollowsTheNormalUnderAnOpenSky) {
  const PatchMesh mesh = bentStrip();
  const std::size_t strip = mesh.size() - 1;
  ASSERT_EQ(mesh.unknowns(), 2u);
  // Under a uniform sky of radiance 1 above black ground: pi (1 + cos tilt) / 2, linear in the
  // normal (Liu & Jordan, "The long-term average performance of flat-plate solar energy
  // collectors", Solar Energy 7, 1963).
  std::vector<double> truth;
  double mean = 0;
  double area = 0;
  for (std::size_t i = 0; i < strip; ++i) {
    truth.push_back(pi * (1 + mesh.normal[i].z) / 2);
    mean += mesh.area[i] * truth.back();
    area += mesh.area[i];
  }
  mean /= area;
  Progress silent;
  const std::vector<double> sky = {1.0};
  const std::vector<double> found = patchIrradiance(mesh, std::vector<double>{0, 0},
                                                    std::vector<double>{mean, pi}, 1, sky, silent);
  double found_mean = 0;
  for (std::size_t i = 0; i < strip; ++i) {
    // 16,384 rays, each of them 0 or pi: 0.4% of pi at random, more at the ends of the strip.
    EXPECT_NEAR(found[i], truth[i], 0.02 * pi) << i;
    found_mean += mesh.area[i] * found[i] / area;
  }
  EXPECT_NEAR(found_mean, mean, 1e-12);
  EXPECT_EQ(found[strip], pi);  // an unknown of one patch keeps its own
}

/// It takes the rays of the first look for those of its own.
TEST(PatchIrradiance, ASecondLookGivesTheBitsOfAFirstOne) {
  const PatchMesh mesh = bentStrip();
  Progress progress;
  const std::vector<double> sky{1.0};
  const std::vector<double> dark(mesh.size(), 0.0);
  std::vector<double> light(mesh.size());
  for (std::size_t i = 0; i < light.size(); ++i) light[i] = 1.0 + double(i % 3);
  PatchIrradiance once(mesh, 1, sky);
  once.look(light, progress);
  PatchIrradiance twice(mesh, 1, sky);
  twice.look(dark, progress);
  const std::vector<double> means(mesh.unknowns(), 2.0);
  EXPECT_NE(twice.around(means), once.around(means));
  twice.look(light, progress);
  EXPECT_EQ(twice.around(means), once.around(means));
  EXPECT_EQ(twice.beyondMeans(), once.beyondMeans());
}

TEST(PatchIrradiance, IsTheSameEverywhereInAFurnace) {
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 2, true);
  PatchMesh mesh = builder.build();
  shareFirstSurface(mesh);
  ASSERT_EQ(mesh.unknowns(), 1u);
  Progress silent;
  const std::vector<double> one(2, 1.0);
  for (const double h : patchIrradiance(mesh, one, one, 2, {}, silent)) EXPECT_EQ(h, 1.0);
}

TEST(PatchIrradiance, IsNeverNegativeAndKeepsTheMean) {
  const PatchMesh mesh = bentStrip();
  Progress silent;
  const std::vector<double> sky = {1.0};
  // A mean far below what the rays find: slopes would take some patches below 0.
  const std::vector<double> found =
      patchIrradiance(mesh, std::vector<double>{0, 0}, std::vector<double>{0.1, 0}, 1, sky, silent);
  double sum = 0;
  double area = 0;
  for (std::size_t i = 0; i + 1 < mesh.size(); ++i) {
    EXPECT_GE(found[i], 0);
    sum += mesh.area[i] * found[i];
    area += mesh.area[i];
  }
  EXPECT_NEAR(sum / area, 0.1, 1e-12);
}

/// The irradiance of the patches of cluster 0 in one band, by the formulas that SeenPatches states;
/// `light`: of patches and the sky.
std::vector<double> byAxes(const PatchMesh& mesh, const SeenPatches& seen,
                           std::span<const double> light, double mean) {
  const std::size_t axes = seen.axes[0];
  const double rays = seen.rays[0];
  std::vector<double> slope(axes, 0.0);
  double sum = 0;
  double squares = 0;
  for (std::size_t k = seen.begin[0]; k < seen.begin[1]; ++k) {
    const double found = seen.hits[k] * light[seen.item[k]] / rays;
    sum += found;
    squares += found * light[seen.item[k]];
    for (std::size_t a = 0; a < axes; ++a) slope[a] += found * double(seen.mean[k * axes + a]);
  }
  double explained = 0;
  for (const double s : slope) explained += rays * s * s;
  const double noise = std::max(0.0, rays * (squares - sum * sum) - explained) / (rays - 7);
  const double kept = std::max(0.0, 1 - 6 * noise / explained);
  std::vector<double> irradiance;
  for (std::size_t i = 0; mesh.unknownOf(i) == 0; ++i) {
    irradiance.push_back(mean);
    for (std::size_t a = 0; a < axes; ++a) {
      irradiance.back() += kept * slope[a] * double(seen.patch[i * axes + a]);
    }
  }
  return irradiance;
}

TEST(SeenPatches, GivesTheIrradianceOfPatchesInAnyLight) {
  PatchMesh mesh = bentStrip();
  Progress silent;
  const SeenPatches seen = seenPatches(mesh, silent);
  ASSERT_EQ(seen.axes.size(), 2u);
  EXPECT_EQ(seen.axes[1], 0);  // an unknown of one patch
  ASSERT_GE(seen.axes[0], 3);  // along the bend, along its axis, and the normal
  const std::vector<double> sky = {0.7};
  for (const double ground : {0.0, 0.3, 5.0}) {
    std::vector<double> light(mesh.size() + 1, 0.2);
    light[mesh.size() - 1] = ground;
    light.back() = pi * sky[0];
    const std::vector<double> by_axes = byAxes(mesh, seen, light, 3);
    light.pop_back();
    PatchIrradiance within(mesh, 1, sky);
    within.look(light, silent);
    const std::vector<double> truth = within.around(std::vector<double>{3, 0});
    // Axes along which the strip hardly spreads are left out: less than a thousandth of the little
    // that they would give; the rest is single precision.
    for (std::size_t i = 0; i < by_axes.size(); ++i) EXPECT_NEAR(by_axes[i], truth[i], 1e-4) << i;
  }
}

TEST(SeenPatches, CountsEveryRayInAClosedRoom) {
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 2, true);
  PatchMesh mesh = builder.build();
  shareFirstSurface(mesh);
  Progress silent;
  const SeenPatches seen = seenPatches(mesh, silent);
  ASSERT_EQ(seen.begin.size(), 2u);
  std::uint32_t hits = 0;
  for (const std::uint32_t of_item : seen.hits) hits += of_item;
  EXPECT_EQ(hits, seen.rays[0]);  // closed: no ray is lost, none ends on a back
  EXPECT_EQ(seen.item.size(), mesh.size());
}

}  // namespace
}  // namespace radiosity
