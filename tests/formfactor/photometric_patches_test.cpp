// Light of photometric lamps on patches and places, against closed forms and by hand.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "formfactor/light_on_patches.h"
#include "support/lamp_files.h"
#include "support/scene_builder.h"
#include "support/scene_files.h"

namespace radiosity {
namespace {

using test::anglesBy;
using test::cosineOf;
using test::IesLamp;

class PhotometricPatches : public test::SceneFiles {
 protected:
  Light lightOfFile(const IesLamp& lamp, const std::string& rest) const {
    Light light = lightOf("ies," + write("lamp.ies", lamp.text()) + rest);
    light.settle(Up::z);
    return light;
  }
  /// lx at places that face up, with nothing on them but the scene.
  std::vector<double> luxAt(const Scene& scene, const Light& light, const std::vector<Vec3>& places,
                            const Vec3& normal = {0, 0, 1}) const {
    Progress quiet;
    MeshOptions options;
    options.faces_as_patches = true;
    const PatchMesh mesh = meshScene(scene, options, quiet).mesh;
    std::vector<LightOnPatches::Place> all;
    all.reserve(places.size());
    for (const Vec3& place : places) all.push_back({place, normal, kNone});
    const std::vector<double> found = LightOnPatches(mesh).aimedAt({&light, 1}, all, 3, quiet);
    std::vector<double> lux;
    for (std::size_t k = 0; k < all.size(); ++k) lux.push_back(found[3 * k] * kLumensPerWatt);
    return lux;
  }
};

Scene farFloor() {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -20, -20, 20, 20, -10);
  return builder.scene();
}

IesLamp cosineLamp(double candela, const std::string& opening = "2 0 0 0") {
  IesLamp lamp;
  lamp.vertical = anglesBy(0, 90, 0.5);
  lamp.candela = [candela](double v, double) { return candela * cosineOf(v); };
  lamp.opening = opening;
  return lamp;
}

// CIE 171:2006, case 5.2: 1000 cd straight down, 3 m above the floor, I0 h^2 / d^4.
TEST_F(PhotometricPatches, ACosineLampLightsAFloor) {
  const std::pair<Vec2, double> table[] = {{{0, 0}, 111.11},   {{.5, 0}, 105.19}, {{1, 0}, 90.00},
                                           {{1.5, 0}, 71.11},  {{.5, .5}, 99.72}, {{1, .5}, 85.66},
                                           {{1.5, .5}, 68.05}, {{1, 1}, 74.38},   {{1.5, 1}, 59.98},
                                           {{1.5, 1.5}, 49.38}};
  std::vector<Vec3> places;
  for (const auto& [at, lux] : table) places.emplace_back(at.x, at.y, 0);
  const std::vector<double> lux =
      luxAt(farFloor(), lightOfFile(cosineLamp(1000), ",at=0,0,3"), places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    // Two decimals, and half a degree between angles: h^2 / 8, 1e-5.
    EXPECT_NEAR(lux[k], table[k].second, 0.006 + 2e-5 * lux[k]);
  }
}

// Each quadrant by hand: I(gamma, C) cos gamma / d^2 between the angles that the file has.
TEST_F(PhotometricPatches, ASkewedLampLightsEachQuadrantAsItsFileSays) {
  IesLamp lamp;
  lamp.vertical = {0, 30, 60, 90};
  lamp.horizontal = {0, 90, 180, 270, 360};
  const double rows[4][4] = {
      {100, 80, 40, 0}, {100, 200, 60, 10}, {100, 50, 90, 0}, {100, 10, 5, 2}};
  lamp.candela = [&](double v, double h) {
    return rows[std::lround(h / 90) % 4][std::lround(v / 30)];
  };
  const Light light = lightOfFile(lamp, ",at=0,0,5");
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    // 45 degrees off straight down, a third of the way from one plane to the next.
    const double around = 90 * quadrant + 30;
    const double* a = rows[quadrant];
    const double* b = rows[(quadrant + 1) % 4];
    const double candela = 2.0 / 3 * (a[1] + a[2]) / 2 + 1.0 / 3 * (b[1] + b[2]) / 2;
    const Vec3 place(5 * cosineOf(around), 5 * test::sineOf(around), 0);
    EXPECT_NEAR(luxAt(farFloor(), light, {place})[0], candela * std::sqrt(.5) / 50, 1e-6)
        << quadrant;
  }
}

/// The configuration factor from a small surface to a parallel a x b rectangle with a corner right
/// above it, at height c.
double cornerFactor(double a, double b, double c) {
  const double x = a / c;
  const double y = b / c;
  return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
         (2 * std::numbers::pi);
}

// A square of 1 m that gives I0 cos gamma is Lambertian: M = pi I0 / A.
TEST_F(PhotometricPatches, ASquareNearByIsASquare) {
  const Light light = lightOfFile(cosineLamp(1000, "2 1 1 0"), ",at=0,0,3");
  const double exitance = std::numbers::pi * 1000;
  const std::vector<double> lux = luxAt(
      farFloor(), light, {{0, 0, 2.5}, {.5, .5, 2.5}, {1.5, .5, 2.5}, {0, 0, 0}, {0, 0, 2.9}});
  // 64 ways of a net miss 1%: below the middle, below a corner, and beside it.
  EXPECT_NEAR(lux[0], exitance * 4 * cornerFactor(.5, .5, .5), 0.01 * lux[0]);
  EXPECT_NEAR(lux[1], exitance * cornerFactor(1, 1, .5), 0.01 * lux[1]);
  EXPECT_NEAR(lux[2], exitance * (cornerFactor(2, 1, .5) - cornerFactor(1, 1, .5)), 0.01 * lux[2]);
  // Three sizes away 16 are enough; a point would be 3.6% off. A tenth of it away there are 1024.
  EXPECT_NEAR(lux[3], exitance * 4 * cornerFactor(.5, .5, 3), 0.002 * lux[3]);
  EXPECT_NEAR(lux[4], exitance * 4 * cornerFactor(.5, .5, .1), 0.02 * lux[4]);
}

// CIE 171:2006, case 5.3: a square metre flush with the ceiling of a room of 4 x 4 x 3 m, 1000 cd;
// the values are those of the closed form.
TEST_F(PhotometricPatches, APanelInTheCeilingLightsFloorAndWall) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(-2, -2, 0), Vec3(2, 2, 3), false);
  const Scene scene = builder.scene();
  const Light light = lightOfFile(cosineLamp(1000, "2 1 1 0"), ",at=0,0,3");
  const auto compare = [&](const std::vector<Vec3>& places, const Vec3& normal,
                           const std::vector<double>& truth) {
    const std::vector<double> lux = luxAt(scene, light, places, normal);
    // 16 ways of a net, or 64.
    for (std::size_t k = 0; k < truth.size(); ++k) EXPECT_NEAR(lux[k], truth[k], 0.01 * truth[k]);
  };
  const double up = 1e-4;  // off the surface, which would stand in the way
  compare({{.25, 0, up}, {.75, 0, up}, {1.25, 0, up}, {1.75, 0, up}}, {0, 0, 1},
          {105.78, 95.67, 79.26, 61.42});
  const double in = 2 - 1e-4;
  compare({{in, 0, 2.75}, {in, 0, 2.25}, {in, 0, 1.75}, {in, 0, 1.25}, {in, 0, .75}, {in, 0, .25}},
          {-1, 0, 0}, {32.68, 75.19, 81.32, 69.06, 53.40, 40.00});
}

// All of it falls on the walls, whatever its shape and wherever it hangs: flush with the ceiling,
// its place is on it.
TEST_F(PhotometricPatches, AClosedRoomGetsAllOfIt) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(0.0), Vec3(4, 4, 3), false);
  MeshOptions options;
  options.patches = 200;
  Progress quiet;
  const PatchMesh mesh = meshScene(builder.scene(), options, quiet).mesh;
  for (const char* opening : {"2 0 0 0", "2 .3 1.2 0", "2 -.4 0 0", "2 .6 .6 .1"}) {
    for (const char* place : {"2,2,3", "1.7,2.2,2.4"}) {
      const bool flush = std::string(place) == "2,2,3";
      if (flush && opening == std::string("2 .6 .6 .1")) continue;  // it is half in the ceiling
      const Light light =
          lightOfFile(cosineLamp(500, opening), ",at=" + std::string(place) + ",turn=20");
      const LightFall fall = LightOnPatches(mesh).aimed({&light, 1}, 3, quiet);
      double watts = 0;
      for (std::size_t i = 0; i < mesh.size(); ++i) watts += mesh.area[i] * fall.irradiance[3 * i];
      // .25% a patch; patches err apart from each other.
      EXPECT_NEAR(watts, light.strength[0], 1e-3 * watts) << opening << " at " << place;
      EXPECT_TRUE(fall.lost.empty());
    }
  }
}

TEST_F(PhotometricPatches, WhatIsInTheCeilingShinesInNoRoom) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(0.0), Vec3(4, 4, 3), false);
  const Scene scene = builder.scene();
  // A plate of .5 m that stands on edge, half above the ceiling: C0 down, so that it is aimed
  // aside.
  const Light hidden = lightOfFile(cosineLamp(1000, "2 .5 .5 0"), ",at=2,2,3,aim=4,2,3");
  const Light whole = lightOfFile(cosineLamp(1000, "2 .5 .5 0"), ",at=2,2,2.5,aim=4,2,2.5");
  const Vec3 wall(-1, 0, 0);
  // Half of a plate; from as far below its middle, all of one.
  const double half = luxAt(scene, hidden, {{3.5, 2, 2.875}}, wall)[0];
  const double all = luxAt(scene, whole, {{3.5, 2, 2.5}}, wall)[0];
  EXPECT_NEAR(half, all / 2, 0.03 * all);
  // Above the ceiling, and in the floor: nothing.
  EXPECT_EQ(luxAt(scene, lightOfFile(cosineLamp(1000), ",at=2,2,3.01"), {{2, 2, 1}})[0], 0);
}

TEST_F(PhotometricPatches, ALampInAWallLightsNothing) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -4, -4, 4, 4, 0);
  builder.box(builder.surface("block"), Vec3(-1, -1, 1), Vec3(1, 1, 2));
  MeshOptions options;
  options.faces_as_patches = true;
  Progress quiet;
  const PatchMesh mesh = meshScene(builder.scene(), options, quiet).mesh;
  const Light light = lightOfFile(cosineLamp(1000, "2 .2 .2 0"), ",at=0,0,1.5,name=in%20it");
  EXPECT_EQ(LightOnPatches(mesh).aimed({&light, 1}, 3, quiet).lost,
            std::vector<std::string>{"in it"});
}

}  // namespace
}  // namespace radiosity
