// Light of skies on patches and places: closed forms, and quadrature over windows.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "formfactor/light_on_patches.h"
#include "support/scene_builder.h"
#include "support/scene_files.h"
#include "support/sky_files.h"
#include "support/window_room.h"

namespace radiosity {
namespace {

using test::roomWithWindow;
using test::throughWindow;

constexpr double kPi = std::numbers::pi;
/// Three standard errors of what overPatch() ends at.
constexpr double kSkyError = 1.5e-2;

PatchMesh facesOf(const Scene& scene) {
  MeshOptions options;
  options.faces_as_patches = true;
  Progress quiet;
  return meshScene(scene, options, quiet).mesh;
}

std::vector<Light> skyOf(const std::string& text) {
  std::vector<Light> lights{lightOf(text)};
  lights[0].settle(Up::z);
  settleSkies(lights, Up::z);
  return lights;
}

LightFall fallOn(const PatchMesh& mesh, const std::vector<Light>& sky, double open) {
  Progress quiet;
  return LightOnPatches(mesh).all(sky, std::vector<double>(mesh.size(), open), 3, quiet);
}

Scene onlyFloor() {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), -2, -2, 2, 2, 0);
  return builder.scene();
}

Scene onlyWall() {
  test::SceneBuilder builder;
  builder.face(builder.surface("wall"), {{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
  return builder.scene();
}

TEST(SkyLight, OpenFloorsGetTheirStrength) {
  const PatchMesh mesh = facesOf(onlyFloor());
  for (int type = 1; type <= 16; ++type) {
    const auto sky = skyOf(fmt::format("cie-sky,5,type={},elevation=30,azimuth=77", type));
    const LightFall fall = fallOn(mesh, sky, 1);
    EXPECT_NEAR(fall.irradiance[0] / 5, 1, kSkyError) << "type " << type;
    EXPECT_LT(fall.error, kSkyError / 3) << "type " << type;
  }
}

// The sun's glare is where few rays go: sets of them may agree by chance.
TEST(SkyLight, ItIsOffByWhatItSays) {
  Progress quiet;
  const PatchMesh mesh = meshScene(onlyFloor(), {.patches = 900}, quiet).mesh;
  for (const int type : {1, 12, 15}) {
    const auto sky = skyOf(fmt::format("cie-sky,5,type={},elevation=40,azimuth=100", type));
    const LightFall fall = fallOn(mesh, sky, 1);
    double squares = 0;
    double largest = 0;
    for (const double value : fall.irradiance) {
      squares += (value / 5 - 1) * (value / 5 - 1);
      largest = std::max(largest, std::abs(value / 5 - 1));
    }
    const double off = std::sqrt(squares / double(fall.irradiance.size()));
    EXPECT_LT(off, 1.3 * fall.error) << "type " << type;
    EXPECT_GT(off, 0.5 * fall.error) << "type " << type;
    EXPECT_LT(largest, kSkyError) << "type " << type;
  }
}

TEST(SkyLight, OpenWallsGetMoonAndSpencersShare) {
  const PatchMesh mesh = facesOf(onlyWall());
  ASSERT_GT(mesh.normal[0].x, 0.99);
  const LightFall fall = fallOn(mesh, skyOf("cie-sky,1,2,3,type=16"), 1);
  const double share = (3 * kPi + 8) / (14 * kPi);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(fall.irradiance[b] / (share * double(b + 1)), 1, kSkyError);
  }
  // The ground gives half of what a whole sphere of its radiance would.
  const LightFall on_ground = fallOn(mesh, skyOf("cie-sky,1,2,3,type=16,ground=0.3"), 1);
  EXPECT_NEAR(on_ground.irradiance[2] / (3 * (share + 0.15)), 1, kSkyError);
}

TEST(SkyLight, PlacesAreLitThroughAWindow) {
  const PatchMesh mesh = facesOf(roomWithWindow(0).scene());
  const auto sky = skyOf("cie-sky,1,type=16");
  std::vector<LightOnPatches::Place> places;
  for (const Vec3& at : {Vec3(2, 1.5, 0.8), Vec3(1.2, 2.5, 0.5), Vec3(3, 1, 0.2)}) {
    places.push_back({at, {0, 0, 1}, kNone});
  }
  Progress quiet;
  const std::vector<double> found = LightOnPatches(mesh).aimedAt(sky, places, 3, quiet);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double expected = throughWindow(places[k].position).y;
    // The window's edge cuts a twentieth of 4,096 rays that are a net: some 3 of 200 are off.
    EXPECT_NEAR(found[3 * k] / expected, 1, 0.02) << k << ": " << expected;
  }
}

TEST(SkyLight, PatchesAreLitThroughAWindow) {
  const double height = 0.7;
  const PatchMesh mesh = facesOf(roomWithWindow(height).scene());
  Vec2 mean(0.0);
  constexpr int kSide = 20;
  for (int k = 0; k < kSide * kSide; ++k) {
    const int row = k / kSide;
    mean += throughWindow({1.5 + (k % kSide + 0.5) / kSide, 1.5 + (row + 0.5) / kSide, height}) /
            double(kSide * kSide);
  }
  const auto sky = skyOf("cie-sky,1,type=16");
  const LightFall fall = fallOn(mesh, sky, mean.x / kPi);
  const std::size_t table = mesh.size() - 1;
  ASSERT_NEAR(mesh.area[table], 1, 1e-12);
  EXPECT_NEAR(fall.irradiance[3 * table] / mean.y, 1, kSkyError);
  // Where nothing is seen to be open there is no light.
  const LightFall closed = fallOn(mesh, sky, 0);
  EXPECT_EQ(*std::ranges::max_element(closed.irradiance), 0);
  EXPECT_EQ(closed.error, 0);
}

class SkyImagesOnPatches : public test::SceneFiles {};

TEST_F(SkyImagesOnPatches, AUniformImageIsAUniformSky) {
  const std::string path =
      write("sky.hdr", test::radianceHdr(8, 4, [](int, int) { return Vec3(1, 2, 0.5); }));
  const PatchMesh mesh = facesOf(roomWithWindow(0.7).scene());
  std::vector<double> open(mesh.size());
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = 0.01 + 0.1 * double(i % 7);
  Progress quiet;
  LightOnPatches lights(mesh);
  const LightFall image = lights.all(skyOf("image-sky," + path + ",2"), open, 3, quiet);
  const LightFall uniform = lights.all(skyOf("sky,2,4,1"), open, 3, quiet);
  for (std::size_t k = 0; k < image.irradiance.size(); ++k) {
    EXPECT_NEAR(image.irradiance[k], uniform.irradiance[k], 1e-12 * uniform.irradiance[k]) << k;
  }
}

TEST_F(SkyImagesOnPatches, ASunOfAnImageIsNotMissed) {
  const int height = 128;
  const std::string path = write("sky.hdr", test::radianceHdr(2 * height, height, [](int x, int y) {
                                   return Vec3(x == 200 && y == 30 ? 16384 : 1);
                                 }));
  const LightFall fall = fallOn(facesOf(onlyFloor()), skyOf("image-sky," + path), 1);
  const double top = std::cos(kPi * 30 / height);
  const double bottom = std::cos(kPi * 31 / height);
  const double by_sun = 16383 * (2 * kPi / (2 * height)) * (top * top - bottom * bottom) / 2;
  ASSERT_GT(by_sun, kPi);
  EXPECT_NEAR(fall.irradiance[0] / (kPi + by_sun), 1, kSkyError);
}

}  // namespace
}  // namespace radiosity
