// Light at points against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/form_factors.h"
#include "radiosity/illuminance.h"
#include "radiosity/point_factors.h"
#include "radiosity/solve.h"
#include "support/scene_builder.h"
#include "support/window_room.h"

namespace radiosity {
namespace {

using test::SceneBuilder;
using enum Measured;

constexpr double kPi = std::numbers::pi;
/// Points stand 2e-6 of the diagonal, here of 8.5 m, off their place: light that falls off with the
/// square of the distance d is off by at most 3 times that over d (length and angle).
double offPlace(double d) { return 3 * 2e-6 * 8.5 / d; }

struct SolvedScene {
  explicit SolvedScene(SceneBuilder& builder, std::vector<Light> lights = {})
      : scene(withLights(builder.scene(), std::move(lights))),
        mesh(meshScene(scene, {.patches = 300}, quiet).mesh),
        materials(patchMaterials(scene, mesh)),
        solution(solve(computeFormFactors(mesh, {}, quiet), materials, mesh, {.tolerance = 1e-9},
                       quiet)) {}
  static Scene withLights(Scene scene, std::vector<Light> lights) {
    scene.up = Up::z;
    for (Light& light : lights) scene.lights.push_back(std::move(light));
    return scene;
  }
  PointLightValues at(const std::vector<Vec3>& points, const Vec3& normal,
                      const IlluminanceOptions& options = {}) {
    return lightAtPoints(mesh, materials, solution.irradiance, {}, points,
                         std::vector<Vec3>(points.size(), normal), Up::z, options, quiet);
  }

  Progress quiet;
  Scene scene;
  PatchMesh mesh;
  PatchMaterials materials;
  Solution solution;
};

Light pointLamp(const Vec3& at, double intensity, const std::string& name = "lamp") {
  Light light{name, PointLight{.at = at}, {intensity, intensity, intensity}};
  return light;
}

SceneBuilder blackFloor() {
  SceneBuilder builder;
  builder.level(builder.surface("floor", 0.0), -3, -3, 3, 3, 0);
  return builder;
}

TEST(LightAtPoints, EveryDirectionOfAFurnaceIsAlike) {
  SceneBuilder builder;
  const double emitted = 0.7;
  const double reflectance = 0.4;
  builder.box(builder.surface("room", reflectance, emitted), {0, 0, 0}, {4, 3, 2}, false);
  SolvedScene furnace(builder);
  const PointLightValues light =
      furnace.at({{1, 1, 1}, {3.9, 0.2, 1.3}}, glm::normalize(Vec3(1, 2, 3)));
  const double radiosity = emitted / (1 - reflectance);
  for (std::size_t k = 0; k < light.size(); ++k) {
    for (std::size_t what = 0; what < kMeasured; ++what) {
      const double direct = light.directOf(k, Measured(what))[1];
      const double indirect = light.indirectOf(k, Measured(what))[1];
      // Emitters whole: Lambert's formula. Cylinders: a mean of exact values.
      EXPECT_NEAR(direct, emitted, 1e-9) << what;
      // Sources are stored in single precision; form factors are good to 1e-3 of a mean one.
      EXPECT_NEAR(indirect, radiosity - emitted, 1e-4) << what;
    }
    EXPECT_LT(light.error[k], 1e-6);
    EXPECT_EQ(light.inside[k], 0);
    // Half a cylinder gets what the whole does, where all sides get the same.
    EXPECT_NEAR(light.semicylindricalLux(k, x_plus), light.lux(k, cylinder),
                1e-3 * light.lux(k, cylinder));
  }
}

TEST(LightAtPoints, APointLampOverAFloorHasItsClosedForms) {
  SceneBuilder builder = blackFloor();
  const Vec3 lamp(0.4, -0.3, 2);
  SolvedScene floor(builder, {pointLamp(lamp, 5)});
  const std::vector<Vec3> points = {{0.4, -0.3, 0}, {1, 1, 0}, {-2, 0.5, 0.8}, {2.5, -2.5, 1.9}};
  const PointLightValues light = floor.at(points, {0, 0, 1});
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 to = lamp - points[k];
    const double d = glm::length(to);
    const Vec3 toward = to / d;
    const double across = 5 / (d * d);
    const double sine = std::hypot(toward.x, toward.y);
    const double off = across * offPlace(d);
    const auto direct = [&](Measured what) { return light.directOf(k, what)[0]; };
    EXPECT_NEAR(direct(facing), across * toward.z, off);
    EXPECT_NEAR(direct(x_plus), across * std::max(0.0, toward.x), off);
    EXPECT_NEAR(direct(x_minus), across * std::max(0.0, -toward.x), off);
    EXPECT_NEAR(direct(y_minus), across * std::max(0.0, -toward.y), off);
    EXPECT_EQ(direct(z_minus), 0);
    // 31 upright surfaces: off by 2 / (4 31^2 - 1) at most.
    const double cylindrical = across * sine / kPi;
    EXPECT_NEAR(direct(cylinder), cylindrical, 5.3e-4 * cylindrical + off);
    // EN 13201-3: I sin(t) (1 + cos(a)) / (pi d^2).
    const double semi = across * (sine + toward.x) / kPi;
    EXPECT_NEAR(light.semicylindricalLux(k, x_plus) / kLumensPerWatt, semi,
                5.3e-4 * cylindrical + 3 * off);
    EXPECT_EQ(light.indirectOf(k, facing)[0], 0);
  }
}

TEST(LightAtPoints, APlateCastsItsShadow) {
  SceneBuilder builder = blackFloor();
  const Index plate = builder.surface("plate", 0.0, 0.0, true);
  builder.level(plate, -0.5, -0.5, 0.5, 0.5, 1);
  SolvedScene floor(builder, {pointLamp({0, 0, 2}, 1)});
  // From the lamp at twice its height the plate's shadow reaches to 1.
  const PointLightValues light =
      floor.at({{0.99, 0.5, 0}, {1.01, 0.5, 0}, {0.3, 0.3, 1.5}}, {0, 0, 1});
  EXPECT_EQ(light.directOf(0, facing)[0], 0);
  EXPECT_EQ(light.directOf(0, cylinder)[0], 0);
  const double d = std::sqrt(1.01 * 1.01 + 0.25 + 4);
  EXPECT_NEAR(light.directOf(1, facing)[0], 2 / (d * d * d), offPlace(d));
  EXPECT_GT(light.directOf(2, facing)[0], 0);
}

/// Direct light of a black scene, and what exact view factors say.
struct DirectLightAt {
  DirectLightAt(SceneBuilder& builder, const std::vector<Vec3>& points)
      : mesh(meshScene(builder.scene(), {.patches = 50}, quiet).mesh) {
    const PatchMaterials materials = patchMaterials(builder.scene(), mesh);
    const std::vector<Vec3> normals(points.size(), Vec3(0, 0, 1));
    found = lightAtPoints(mesh, materials, std::vector<double>(3 * mesh.size(), 0.0), {}, points,
                          normals, Up::z, {}, quiet);
    std::vector<double> factors(points.size() * mesh.size());
    pointFormFactors(mesh, points, normals, factors, quiet);
    for (std::size_t k = 0; k < points.size(); ++k) {
      exact.push_back(0);
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        exact.back() += factors[k * mesh.size() + i] * materials.emission[3 * i];
      }
    }
  }
  double off(std::size_t k) const { return found.directOf(k, facing)[0] - exact[k]; }

  Progress quiet;
  PatchMesh mesh;
  PointLightValues found;
  std::vector<double> exact;
};

std::vector<Vec3> squareOfPoints(int side, double step, double z) {
  std::vector<Vec3> points;
  points.reserve(std::size_t(side) * std::size_t(side));
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      points.emplace_back(step * (x - 0.5 * (side - 1)), step * (y - 0.5 * (side - 1)), z);
    }
  }
  return points;
}

TEST(LightAtPoints, PenumbrasAreExact) {
  SceneBuilder builder = blackFloor();
  builder.level(builder.surface("panel", 0.0, 7), -1, -1, 1, 1, 2, false);
  const Index plate = builder.surface("plate", 0.0, 0.0, true);
  builder.level(plate, -0.4, -0.9, 0.5, 0.3, 1);
  builder.level(plate, 0.9, -1, 1.1, 1, 1.2);
  const std::vector<Vec3> points = squareOfPoints(11, 0.4, 0.3);
  const DirectLightAt light(builder, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    // The plates are .7 m away, and points 17 micrometres off their place.
    EXPECT_NEAR(light.off(k), 0, 7 * offPlace(0.7)) << k;
    EXPECT_EQ(light.found.error[k], 0);
  }
}

TEST(LightAtPoints, PastManySlatsTheErrorIsTold) {
  SceneBuilder builder = blackFloor();
  builder.level(builder.surface("panel", 0.0, 7), -1, -1, 1, 1, 2, false);
  const Index slats = builder.surface("slats", 0.0, 0.0, true);
  constexpr int kSlats = 300;  // more than are clipped
  const double step = 3.0 / kSlats;
  for (int k = 0; k < kSlats; ++k) {
    builder.level(slats, -1.5 + k * step, -1.5, -1.5 + (k + 0.6) * step, 1.5, 1);
  }
  const std::vector<Vec3> points = squareOfPoints(3, 0.3, 0);
  const DirectLightAt light(builder, points);
  double squares = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_GT(light.found.error[k], 0);
    EXPECT_LE(light.found.error[k], 0.01);
    const double off = light.off(k) / light.exact[k];
    squares += off * off / (light.found.error[k] * light.found.error[k]);
  }
  // Of at least four sets: the mean of squares over estimates of three degrees of freedom is 3, and
  // points share their sets.
  EXPECT_LT(squares / double(points.size()), 6);
}

TEST(LightAtPoints, ASkyFillsWhatIsOpen) {
  SceneBuilder builder = blackFloor();
  SolvedScene floor(builder, {uniformSky({2, 2, 2})});
  const PointLightValues light = floor.at({{0, 0, 0}}, {0, 0, 1});
  // Over the floor all that faces up sees the sky, upright surfaces half of it.
  EXPECT_NEAR(light.indirectOf(0, facing)[0], 2 * kPi, 1e-12);
  // What the floor's edge leaves open: 3 m off, and points stand 17 micrometres up. Rays: 1,024.
  EXPECT_NEAR(light.indirectOf(0, x_plus)[0], kPi, 0.01 * kPi);
  EXPECT_NEAR(light.indirectOf(0, cylinder)[0], kPi, 0.01 * kPi);
}

// In a black room it is the sky component of textbooks.
TEST(LightAtPoints, TheDaylightFactorIsThatThroughAWindow) {
  SceneBuilder builder = test::roomWithWindow(0, 0.0);
  std::vector<Light> sky{lightOf("cie-sky,10000lx,type=16")};
  sky[0].settle(Up::z);
  SolvedScene room(builder, sky);
  const std::vector<Vec3> points{{2, 1.5, 0.8}, {1.2, 2.5, 0.5}, {3, 1, 0.2}, {0.5, 3, 0.8}};
  const PointLightValues light = room.at(points, {0, 0, 1}, {.tolerance = 2e-3});
  EXPECT_NEAR(light.open_lux, 10000, 1e-9);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double expected = 100 * test::throughWindow(points[k]).y;
    // Three standard errors, as they are stated.
    EXPECT_NEAR(light.daylightFactor(k) / expected, 1, 3 * light.error[k]) << k;
    EXPECT_LT(light.error[k], 0.02) << k;  // of 32,768 rays all around
  }
  SolvedScene clear(builder, {uniformSky({2, 2, 2})});
  EXPECT_NEAR(clear.at(points, {0, 0, 1}).open_lux, 683 * 2 * kPi, 1e-9);
  SolvedScene lit(builder, {sky[0], pointLamp({2, 2, 2}, 10)});
  EXPECT_EQ(lit.at(points, {0, 0, 1}).open_lux, 0);
}

TEST(LightAtPoints, AStatedErrorHoldsAndFalls) {
  // Half of a room is dark: rays have something to miss.
  SceneBuilder builder;
  builder.box(builder.surface("room", 0.6), {0, 0, 0}, {4, 4, 3}, false);
  SolvedScene room(builder, {pointLamp({0.5, 0.5, 1}, 10)});
  std::vector<Vec3> points;
  points.reserve(64);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) points.emplace_back(0.3 + 0.45 * x, 0.3 + 0.45 * y, 0.8);
  }
  const PointLightValues good = room.at(points, {0, 0, 1}, {.tolerance = 5e-4});
  const PointLightValues fair = room.at(points, {0, 0, 1}, {.tolerance = 0.02, .seed = 5});
  EXPECT_LE(fair.report.largest_error, 0.02);
  EXPECT_LT(fair.report.rays, good.report.rays);
  double squares = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double off = fair.lux(k, facing) / good.lux(k, facing) - 1;
    squares += off * off / (fair.error[k] * fair.error[k]);
  }
  // The mean square of 64 errors over their estimates, of seven degrees of freedom each, is
  // 7 / 5 +- .5.
  EXPECT_LT(squares / 64, 3);
  EXPECT_GT(squares / 64, 0.4);
}

TEST(LightAtPoints, APointInABodySaysSo) {
  SceneBuilder builder;
  builder.box(builder.surface("room", 0.5), {0, 0, 0}, {4, 4, 3}, false);
  builder.box(builder.surface("box", 0.5), {1, 1, 0}, {2, 2, 1});
  SolvedScene room(builder, {pointLamp({3, 3, 2}, 1)});
  const PointLightValues light =
      room.at({{1.5, 1.5, 0.8}, {1.5, 1.5, 1.2}, {0.5, 0.5, 0}}, {0, 0, 1});
  EXPECT_EQ(light.inside, (std::vector<std::uint8_t>{1, 0, 0}));
  // It has no part in the mean error of the others.
  EXPECT_GT(light.report.ray_error, 0);
  EXPECT_NEAR(light.report.ray_error, std::hypot(light.error[1], light.error[2]) / std::sqrt(2.0),
              1e-12);
}

TEST(LightAtPoints, ThreadsAndCompanyChangeNothing) {
  SceneBuilder builder;
  builder.box(builder.surface("room", 0.5, 0.1), {0, 0, 0}, {4, 4, 3}, false);
  SolvedScene room(builder, {pointLamp({3, 3, 2}, 1)});
  const PointLightValues both = room.at({{1, 1, 1}, {2, 3, 1}}, {0, 0, 1});
  setThreads(1);
  const PointLightValues one = room.at({{2, 3, 1}}, {0, 0, 1});
  setThreads(0);
  for (std::size_t what = 0; what < kMeasured; ++what) {
    EXPECT_EQ(both.lux(1, Measured(what)), one.lux(0, Measured(what)));
  }
}

TEST(LightAtPoints, WrongArgumentsAreRefused) {
  SceneBuilder builder = blackFloor();
  SolvedScene floor(builder, {pointLamp({0, 0, 2}, 1)});
  EXPECT_THROW(floor.at({{0, 0, NAN}}, {0, 0, 1}), InputError);
  EXPECT_THROW(floor.at({{0, 0, 0}}, {0, 0, 0}), InputError);
  EXPECT_THROW(floor.at({{0, 0, 0}}, {0, 0, 1}, {.tolerance = 0}), InputError);
}

TEST(Illuminance, LumensAreCountedByBands) {
  EXPECT_DOUBLE_EQ(photometricOf(std::vector<double>{1, 1, 1}), 683);
  EXPECT_DOUBLE_EQ(photometricOf(std::vector<double>{0, 1, 0}), 683 * 0.7152);
  EXPECT_DOUBLE_EQ(photometricOf(std::vector<double>{2}), 1366);
  EXPECT_THROW(photometricOf(std::vector<double>{1, 1}), InputError);
}

TEST(Illuminance, ASummaryHasTheFiguresOfAPlan) {
  MeasuringPoints points;
  points.at = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  PointLightValues light;
  light.bands = 1;
  light.error.assign(4, 0.0);
  light.inside = {0, 0, 1, 0};
  light.direct.assign(4 * kMeasured, 0.0);
  light.indirect.assign(4 * kMeasured, 0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    light.direct[k * kMeasured] = double(k) / 683;
    light.indirect[k * kMeasured] = 1.0 / 683;
  }
  const IlluminanceSummary s = summaryOf(points, light, 0);
  EXPECT_EQ(s.points, 3U);
  EXPECT_EQ(s.inside, 1U);
  EXPECT_DOUBLE_EQ(s.lowest, 1);
  EXPECT_DOUBLE_EQ(s.highest, 4);
  EXPECT_DOUBLE_EQ(s.mean, 7.0 / 3);
  EXPECT_DOUBLE_EQ(s.indirect, 1);
  EXPECT_DOUBLE_EQ(s.overMean(), 3.0 / 7);
  EXPECT_DOUBLE_EQ(s.overHighest(), 0.25);
  EXPECT_EQ(s.highest_at, Vec3(3, 0, 0));
}

}  // namespace
}  // namespace radiosity
