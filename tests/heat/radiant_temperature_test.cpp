// Mean radiant temperature against isothermal rooms, and the definition of form factors.
#include "radiosity/radiant_temperature.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "support/error_of.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

constexpr double kWidth = 4;
constexpr double kHeight = 3;
constexpr double kDepth = 5;

double fourth(double temperature) { return std::pow(temperature, 4); }

PatchMesh meshOf(SceneBuilder& builder) {
  Progress quiet;
  return meshScene(builder.scene(), {.patches = 60}, quiet).mesh;
}

PatchMesh room() {
  SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(0), Vec3(kWidth, kHeight, kDepth), false);
  return meshOf(builder);
}

/// Black surfaces of these temperatures.
HeatSolution blackHeat(const std::vector<double>& temperature) {
  HeatSolution heat;
  for (const double t : temperature) heat.radiosity.push_back(kStefanBoltzmann * fourth(t));
  return heat;
}

/// The form factor of the ceiling from a small surface, by its definition: the integral of
/// cos(t1) cos(t2) / (pi r^2). Cells meet under the point, where the second cosine has a kink.
double factorOfCeiling(const Vec3& from, const Vec3& normal) {
  constexpr int kCells = 600;
  double sum = 0;
  for (int i = 0; i < kCells; ++i) {
    for (int k = 0; k < kCells; ++k) {
      const Vec3 to =
          Vec3((i + 0.5) * kWidth / kCells, kHeight, (k + 0.5) * kDepth / kCells) - from;
      const double square = glm::dot(to, to);
      sum += std::max(0.0, glm::dot(to, normal)) * to.y / (square * square);
    }
  }
  return sum * kWidth * kDepth / (kCells * kCells) / std::numbers::pi;
}

TEST(RadiantTemperature, AnIsothermalRoomIsAsWarmAsItsWalls) {
  const PatchMesh mesh = room();
  const std::vector<Vec3> points = {{2, 1, 2.5}, {0.1, 0.1, 4.9}, {3.9, 2.9, 0.2}, {2, 0, 2}};
  HeatOptions options;
  options.sky_temperature = 900;  // there is none
  Progress quiet;
  const RadiantTemperatures found = radiantTemperatures(
      mesh, blackHeat(std::vector<double>(mesh.size(), 296.5)), options, points, Up::y, quiet);
  ASSERT_EQ(found.size(), points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    // Point form factors are exact but for rounding, of numbers of 1e-9 in Lambert's formula. The
    // last point is on the floor: its lower face sees none of it.
    if (k == 3) continue;
    EXPECT_NEAR(found.standing[k], 296.5, 1e-6) << k;
    EXPECT_NEAR(found.seated[k], 296.5, 1e-6) << k;
    for (std::size_t face = 0; face < kRadiantFaces; ++face) {
      EXPECT_NEAR(found.plane[k * kRadiantFaces + face], 296.5, 1e-6) << k << " " << face;
    }
    EXPECT_NEAR(found.surfaces[k], 1, 1e-9);
  }
}

TEST(RadiantTemperature, AWarmCeilingCountsByItsFormFactors) {
  const PatchMesh mesh = room();
  const double cool = 290;
  const double warm = 330;
  std::vector<double> temperature(mesh.size(), cool);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.centroid[i].y > kHeight - 1e-9) temperature[i] = warm;
  }
  const Vec3 point(2, 1.2, 2.5);
  Progress quiet;
  const RadiantTemperatures found =
      radiantTemperatures(mesh, blackHeat(temperature), {}, {&point, 1}, Up::y, quiet);
  const auto plane = [&](const Vec3& normal) {
    return fourth(cool) + factorOfCeiling(point, normal) * (fourth(warm) - fourth(cool));
  };
  const double up = plane({0, 1, 0});
  const double across = plane({1, 0, 0});
  const double along = plane({0, 0, 1});
  const double down = fourth(cool);
  const double truth[] = {across, across, up, down, along, along};
  for (std::size_t face = 0; face < kRadiantFaces; ++face) {
    // 600 cells a side at 1.8 m: the midpoint rule is off by 1e-5 of the ceiling's part, a tenth.
    EXPECT_NEAR(found.plane[face], std::pow(truth[face], 0.25), 1e-3) << kRadiantFaceNames[face];
  }
  // ISO 7726, annex B: who faces no way in particular shows as much to the sides.
  const double sides = 2 * (across + along);
  EXPECT_NEAR(found.standing[0],
              std::pow((0.08 * (up + down) + 0.29 * sides) / (2 * (0.08 + 0.23 + 0.35)), 0.25),
              1e-3);
  EXPECT_NEAR(found.seated[0],
              std::pow((0.18 * (up + down) + 0.26 * sides) / (2 * (0.18 + 0.22 + 0.30)), 0.25),
              1e-3);
}

TEST(RadiantTemperature, BandsAddUpAndTheSkyIsAbove) {
  SceneBuilder builder;
  builder.level(builder.surface("ground"), -1e4, -1e4, 1e4, 1e4, 0);
  const PatchMesh mesh = meshOf(builder);
  HeatSolution heat;
  heat.bands = 2;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (const double share : {0.25, 0.75}) {
      heat.radiosity.push_back(share * kStefanBoltzmann * fourth(300));
    }
  }
  HeatOptions options;
  options.sky_temperature = 250;
  const Vec3 point(0, 0, 1);
  Progress quiet;
  const RadiantTemperatures found =
      radiantTemperatures(mesh, heat, options, {&point, 1}, Up::z, quiet);
  EXPECT_NEAR(found.plane[4], 250, 1e-9);
  // The ground ends 1e4 heights away: 1e-8 of the view below, 1e-4 of that to the sides.
  EXPECT_NEAR(found.plane[5], 300, 1e-5);
  for (const std::size_t face : {0, 1, 2, 3}) {
    EXPECT_NEAR(found.plane[face], std::pow((fourth(250) + fourth(300)) / 2, 0.25), 5e-3);
  }
  EXPECT_NEAR(found.surfaces[0], 0.5, 1e-4);
  const std::string refused = test::errorOf([&] {
    radiantTemperatures(room(), heat, options, {&point, 1}, Up::z, quiet);
  });
  EXPECT_NE(refused.find("another mesh"), std::string::npos) << refused;
}

}  // namespace
}  // namespace radiosity
