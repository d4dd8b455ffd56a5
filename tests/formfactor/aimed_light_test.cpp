// Light of points and suns on patches: closed forms, and shadows whose areas are known.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/light_on_patches.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

constexpr double kPi = std::numbers::pi;
/// Three standard errors of what overPatch() ends at, of what a patch gets with nothing in between.
constexpr double kShadowError = 7.5e-3;
/// Of shadows with sharp edges: rounding, at places 100 scenes from the origin.
constexpr double kExactShadow = 1e-11;

PatchMesh facesOf(const Scene& scene) {
  MeshOptions options;
  options.faces_as_patches = true;
  Progress quiet;
  return meshScene(scene, options, quiet).mesh;
}

LightFall fallOn(const PatchMesh& mesh, const std::string& text) {
  Light light = lightOf(text);
  light.settle(Up::z);
  Progress quiet;
  return LightOnPatches(mesh).aimed({&light, 1}, 3, quiet);
}

/// The mean irradiance of patches that face along `normal`, over their common area.
double meanFacing(const PatchMesh& mesh, const LightFall& fall, const Vec3& normal,
                  double least_area) {
  double sum = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (glm::dot(mesh.normal[i], normal) < 0.999 || mesh.area[i] < least_area) continue;
    sum += mesh.area[i] * fall.irradiance[3 * i];
    area += mesh.area[i];
  }
  return sum / area;
}

/// A floor of 4 x 4, and a plate of 1 x 1 that is `height` above it, scaled and moved.
Scene plateOverFloor(double height, double scale, const Vec3& by) {
  test::SceneBuilder builder;
  const auto level = [&](const char* name, double half, double z, bool up) {
    const double s = scale;
    std::vector<Vec3> p{{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
    if (!up) p = {p[0], p[3], p[2], p[1]};
    for (Vec3& corner : p) corner = s * corner + by;
    builder.face(builder.surface(name), p);
  };
  level("floor", 2, 0, true);
  level("plate", 0.5, height, true);
  return builder.scene();
}

TEST(AimedLight, ACubeGetsAllOfAPoint) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(-2.0), Vec3(2.0), false);
  const PatchMesh mesh = facesOf(builder.scene());
  const LightFall fall = fallOn(mesh, "point,3,at=.5,-1,1.9");
  double power = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) power += mesh.area[i] * fall.irradiance[3 * i];
  // Solid angles of all faces; nothing is hidden, so points do not count.
  EXPECT_NEAR(power, 3 * 4 * kPi, 1e-13 * power);
  EXPECT_EQ(fall.error, 0.0);
  // From the middle each face gets a sixth.
  for (const double h : fallOn(mesh, "point,1").irradiance) EXPECT_NEAR(h, 4 * kPi / 96, 1e-15);
}

// The shadow of a plate by a point: similar, larger by the ratio of the heights.
TEST(AimedLight, APlateCastsItsShadow) {
  for (const auto& [scale, by] :
       {std::pair{1.0, Vec3(0.0)}, {1e-3, Vec3(.1, 2, 0)}, {1e3, Vec3(1e5)}}) {
    const PatchMesh mesh = facesOf(plateOverFloor(1, scale, by));
    const Vec3 lamp = scale * Vec3(0, 0, 2) + by;
    const LightFall fall =
        fallOn(mesh, fmt::format("point,{},at={},{},{}", scale * scale, lamp.x, lamp.y, lamp.z));
    // Solid angle of a square of half edge a at distance d: 4 atan(a^2 / (d sqrt(d^2 + 2 a^2))).
    const auto solid = [](double a, double d) {
      return 4 * std::atan(a * a / (d * std::sqrt(d * d + 2 * a * a)));
    };
    EXPECT_NEAR(meanFacing(mesh, fall, {0, 0, 1}, 4 * scale * scale),
                (solid(2, 2) - solid(1, 2)) / 16, kExactShadow * solid(2, 2) / 16)
        << scale;
    EXPECT_EQ(fall.error, 0.0);
  }
}

TEST(AimedLight, ASunCastsAPlateAsItIs) {
  for (const auto& [scale, by] :
       {std::pair{1.0, Vec3(0.0)}, {1e-3, Vec3(.1, 2, 0)}, {1e3, Vec3(1e5)}}) {
    const PatchMesh mesh = facesOf(plateOverFloor(0.5, scale, by));
    for (const double diameter : {0.0, 0.533, 5.0}) {
      const LightFall fall =
          fallOn(mesh, fmt::format("sun,100,elevation=45,azimuth=110,diameter={}", diameter));
      const double whole = 100 * std::sqrt(0.5);
      // The shadow is the plate, moved: 1 of 16. A disc blurs its edges, but they stay on the
      // floor.
      EXPECT_NEAR(meanFacing(mesh, fall, {0, 0, 1}, 4 * scale * scale), whole * 15 / 16,
                  (diameter == 0 ? kExactShadow : kShadowError) * whole)
          << scale << " " << diameter;
    }
  }
}

// Slats of .1, .23 apart and .5 above a plate of 1 x 1, which a sun towards (.6, .3, 1) moves by
// -.3 across: what of them is between .3 and 1.3 stands in its way.
TEST(AimedLight, ASunCastsALouvreAsItIs) {
  test::SceneBuilder builder;
  builder.level(builder.surface("plate"), 0, 0, 1, 1, 0);
  double hidden = 0;
  for (int k = 0; k < 20; ++k) {
    const double from = -2 + 0.23 * k;
    builder.level(builder.surface(fmt::format("slat {}", k)), from, -3, from + 0.1, 4, 0.5);
    hidden += std::max(0.0, std::min(1.3, from + 0.1) - std::max(0.3, from));
  }
  const PatchMesh mesh = facesOf(builder.scene());
  const LightFall fall = fallOn(mesh, "sun,1000,toward=.6,.3,1,diameter=0");
  EXPECT_NEAR(fall.irradiance[0], 1000 / std::sqrt(1.45) * (1 - hidden), 1e-8);  // rounding
}

// A unit cube .2 above a floor of 6 x 6: its shadow is that of its three faces that see the sun,
// 1 + .6 + .3.
TEST(AimedLight, ASunCastsACubeAsItIs) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -3, -3, 3, 3, 0);
  builder.box(builder.surface("cube"), Vec3(-0.5, -0.5, 0.2), Vec3(0.5, 0.5, 1.2));
  const PatchMesh mesh = facesOf(builder.scene());
  const LightFall fall = fallOn(mesh, "sun,1000,toward=.6,.3,1,diameter=0");
  EXPECT_NEAR(fall.irradiance[0], 1000 / std::sqrt(1.45) * (1 - 1.9 / 36), 1e-8);  // rounding
}

// Half of a sphere is lit, and of a cube the faces that look at the sun by their cosine.
TEST(AimedLight, BodiesAreLitOnTheSideOfTheSun) {
  test::SceneBuilder builder;
  builder.box(builder.surface("cube"), Vec3(-1.0), Vec3(1.0));
  const PatchMesh mesh = facesOf(builder.scene());
  const LightFall fall = fallOn(mesh, "sun,1,toward=1,2,3,diameter=0");
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const double cosine = glm::dot(mesh.normal[i], glm::normalize(Vec3(1, 2, 3)));
    EXPECT_NEAR(fall.irradiance[3 * i], std::max(0.0, cosine), 1e-14);
  }
}

TEST(AimedLight, NothingComesFromBehindOrAlongASurface) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -1, -1, 1, 1, 0);
  const PatchMesh mesh = facesOf(builder.scene());
  for (const char* text : {"point,1,at=0,0,-1", "point,1,at=5,0,0", "point,1,at=0,0,0",
                           "sun,1,toward=1,0,0,diameter=0", "sun,1,toward=0,0,-1"}) {
    const LightFall fall = fallOn(mesh, text);
    for (const double h : fall.irradiance) EXPECT_EQ(h, 0.0) << text;
    EXPECT_EQ(fall.lost.size(), 1u) << text;
  }
}

// A spot whose cone ends on the floor: its whole power, by points of the patches.
TEST(AimedLight, AFloorGetsAllOfASpot) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -4, -4, 4, 4, 0);
  const PatchMesh mesh = facesOf(builder.scene());
  const LightFall fall = fallOn(mesh, "spot,6W,at=0,0,2,aim=0,0,0,inner=20,outer=40");
  EXPECT_NEAR(64 * fall.irradiance[0], 6, kShadowError * 6);
}

TEST(AimedLight, PointsSeeALampOrDoNot) {
  const PatchMesh mesh = facesOf(plateOverFloor(1, 1, Vec3(0.0)));
  const Light lamp = lightOf("point,8,at=0,0,2");
  const std::vector<LightOnPatches::Place> places{
      {{0.9, 0.9, 0}, {0, 0, 1}, kNone},
      {{1.5, 0, 0}, {0, 0, 1}, kNone},
      {{1.5, 0, 0}, {0, 0, -1}, kNone},
      {{0, 0, 1}, {0, 0, 1}, mesh.polygon[mesh.size() - 1]}};
  Progress quiet;
  const std::vector<double> h = LightOnPatches(mesh).aimedAt({&lamp, 1}, places, 3, quiet);
  EXPECT_EQ(h[0], 0.0);
  EXPECT_NEAR(h[3], 8 * 2 / std::pow(1.5 * 1.5 + 4, 1.5), 1e-14);
  EXPECT_EQ(h[6], 0.0);
  EXPECT_NEAR(h[9], 8, 1e-14);
}

}  // namespace
}  // namespace radiosity
