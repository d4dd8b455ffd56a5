// Light gathered at every pixel: against a furnace, and against elements, of which it is the limit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/form_factors.h"
#include "radiosity/render.h"
#include "radiosity/solve.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

RenderOptions square(int width) {
  RenderOptions options;
  options.width = options.height = width;
  return options;
}

/// A solved scene and its camera.
struct Solved {
  Solved(const Scene& scene, const Camera& from, std::size_t patches) : camera(from) {
    Progress quiet;
    mesh = meshScene(scene, {.patches = patches}, quiet).mesh;
    materials = patchMaterials(scene, mesh);
    FormFactorOptions options;
    options.method = FormFactorMethod::exact;
    const FormFactors factors = computeFormFactors(mesh, options, quiet);
    const Solution solution = solve(factors, materials, mesh, {}, quiet);
    irradiance = solution.irradiance;
    light = surfaceLight(solution.radiosity, materials);
    light.reflectance = materials.reflectance;
    light.emission = materials.emission;
  }

  PixelGather gather(int width, const PixelGatherOptions& options = {}) {
    Progress quiet;
    light.points = std::make_shared<const LightAtPoints>(
        mesh, materials, irradiance, ElementOptions(), std::span<const std::uint8_t>(), quiet);
    return gatherRadiance(mesh, light, camera, square(width), options, quiet);
  }

  Image elements(int width) {
    Progress quiet;
    light.elements = std::make_shared<const Elements>(
        computeElements(mesh, materials, irradiance, {}, {}, quiet));
    return renderRadiance(mesh, light, camera, square(width), quiet);
  }

  Camera camera;
  PatchMesh mesh;
  PatchMaterials materials;
  std::vector<double> irradiance;
  SurfaceLight light;
};

/// rho = .5 and E = 1 all around: B = 2, whatever directions rays take.
TEST(PixelGather, AFurnaceIsConstant) {
  SceneBuilder builder;
  builder.box(builder.surface("wall", 0.5, 1.0), Vec3(0), Vec3(1), false);
  Camera camera;
  camera.eye = {0.2, 0.3, 0.4};
  camera.target = {1, 0.6, 0.5};
  Solved furnace(builder.scene(), camera, 150);
  const PixelGather found = furnace.gather(32, {.rays = 64});
  // Sources are stored in single precision, and the matrix is good to 1e-3: so is every ray.
  for (std::size_t p = 0; p < found.radiance.rgba.size(); p += 4) {
    ASSERT_NEAR(found.radiance.rgba[p] * std::numbers::pi, 2, 1e-3);
  }
  EXPECT_LT(found.report.ray_error, 1e-3);
  EXPECT_GE(found.report.points, 32u * 32u * 4u);
}

Scene cornellBox() { return loadScene(RADIOSITY_SOURCE_DIR "/data/cornell-box.obj"); }

/// Means over the pixels that are hit, of all bands.
double meanOf(const Image& image) {
  double sum = 0;
  double share = 0;
  for (std::size_t p = 0; p < image.rgba.size(); p += 4) {
    share += image.rgba[p + 3];
    for (int b = 0; b < 3; ++b) sum += image.rgba[p + b] * image.rgba[p + 3];
  }
  return sum / share;
}

/// Interpolation is low by .1% in the mean; rays of 1% a pixel leave .02% of the mean of 4,096
/// pixels.
TEST(PixelGather, TheMeanEqualsThatOfElements) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 500);
  const double of_pixels = meanOf(box.gather(64).radiance);
  EXPECT_NEAR(of_pixels / meanOf(box.elements(64)), 1, 2e-3);
}

/// A picture by 32 times as many rays is nearly free of noise: the difference is the other one's
/// noise.
TEST(PixelGather, NoiseMatchesTheStatedError) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 500);
  const PixelGather coarse = box.gather(32, {.rays = 128});
  const PixelGather fine = box.gather(32, {.rays = 4096});
  double off = 0;
  double whole = 0;
  for (std::size_t p = 0; p < fine.radiance.rgba.size(); p += 4) {
    // The lamp shines, and pixels at edges of the box are partly empty.
    const float brightest = fine.radiance.rgba[p];
    if (fine.radiance.rgba[p + 3] < 1 || brightest > 1) continue;
    double one = 0;
    double other = 0;
    for (int b = 0; b < 3; ++b) {
      one += coarse.radiance.rgba[p + b];
      other += fine.radiance.rgba[p + b];
    }
    off += (one - other) * (one - other);
    whole += other * other;
  }
  const double measured = std::sqrt(off / whole);
  // Both are root mean squares over a thousand pixels, of which few are much worse than others.
  EXPECT_NEAR(measured / coarse.report.ray_error, 1, 0.25);
  EXPECT_LT(fine.report.ray_error, coarse.report.ray_error / 4);
}

TEST(PixelGather, AnyNumberOfThreadsGivesTheSameBits) {
  const Scene scene = cornellBox();
  const auto withThreads = [&](int threads) {
    setThreads(threads);
    PixelGather found = Solved(scene, scene.cameras.at(0), 200).gather(66, {.rays = 64});
    setThreads(0);
    return found;
  };
  const PixelGather one = withThreads(1);
  const PixelGather two = withThreads(2);
  EXPECT_EQ(one.radiance.rgba, two.radiance.rgba);
  EXPECT_EQ(one.report.ray_error, two.report.ray_error);
}

TEST(PixelGather, ForecastsMatchTheWorkDone) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 200);
  const PixelGather done = box.gather(256, {.rays = 64});
  Progress quiet;
  const PixelGatherReport foreseen =
      foreseeGather(box.mesh, box.light, box.camera, square(256), {.rays = 64}, quiet);
  // 256 of 65,536 pixels, one in ten with 16 points and not 4: a standard error of 5%.
  EXPECT_NEAR(double(foreseen.points) / double(done.report.points), 1, 0.15);
  EXPECT_NEAR(foreseen.rays / done.report.rays, 1, 0.15);
  EXPECT_GT(foreseen.seconds, 0);
}

TEST(PixelGather, TheNumberOfRaysIsBounded) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 200);
  const PixelGather found = box.gather(32, {.rays = 1024, .most_rays = 32 * 32 * 256});
  EXPECT_EQ(found.report.rays_a_pixel, 256);
  EXPECT_LE(found.report.rays, 32 * 32 * 256);
}

/// Cancelled after the first tile.
class OneTile : public Progress {
 public:
  void advance(std::size_t /*steps*/) override { cancel(); }
};

TEST(PixelGather, CanBeCancelled) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 200);
  box.gather(32, {.rays = 64});
  OneTile progress;
  EXPECT_THROW(gatherRadiance(box.mesh, box.light, box.camera, square(256), {.rays = 64}, progress),
               Cancelled);
}

TEST(PixelGather, ImpossibleInputIsRefused) {
  const Scene scene = cornellBox();
  Solved box(scene, scene.cameras.at(0), 200);
  EXPECT_THROW(box.gather(32, {.rays = 0}), InputError);
  Progress quiet;
  SurfaceLight without = box.light;
  without.points = nullptr;
  EXPECT_THROW(gatherRadiance(box.mesh, without, box.camera, {}, {}, quiet), InputError);
  EXPECT_NO_THROW(PixelGatherOptions().validate());
}

/// A square under an even sky of radiance 1: B = pi rho, radiance rho, texel by texel.
TEST(Textures, AreDrawnTexelByTexel) {
  SceneBuilder builder;
  builder.surface("sign");
  builder.level(0, -1, -1, 1, 1, 0);
  Scene scene = builder.scene();
  scene.lights = {uniformSky({1, 1, 1})};
  scene.materials[0].reflectance = Vec3(1.0);
  scene.materials[0].texture = 0;
  // Four quarters, each of 2 x 2 alike texels, so that pixels within them are not blurred.
  Texture texture{.name = "", .width = 4, .height = 4, .texels = {}, .repeat = false};
  const auto quarter = [](int i, int j) {
    return 0.1F + (i < 2 ? 0.0F : 0.2F) + (j < 2 ? 0.0F : 0.4F);
  };
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      for (int b = 0; b < 3; ++b) texture.texels.push_back(quarter(i, j));
    }
  }
  scene.textures = {texture};
  scene.texcoords = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  Camera camera;
  camera.eye = {0, 0, 10};
  camera.target = {0, 0, 0};
  Solved solved(scene, camera, 1);
  const auto at = [](const Image& image, int i, int j) {
    // Centre of texel (i, j): the square spans 2 / (2 * 10 * tan(fov / 2)) of the picture.
    const double half = 0.5 * image.width / (10 * std::tan(0.5 * Camera().vertical_fov));
    const int x = int(0.5 * image.width + (i - 1.5) / 2 * half);
    const int y = int(0.5 * image.height + (j - 1.5) / 2 * half);
    return double(image.rgba[4 * std::size_t(y * image.width + x)]);
  };
  const double mean = 0.4;
  EXPECT_NEAR(at(solved.elements(128), 0, 0), mean, 1e-3) << "means over patches";
  Progress quiet;
  solved.light.materials = pointMaterials(scene, solved.mesh, solved.materials);
  // Irradiance is pi: rays at the square end in the sky alone. Texels are single precision.
  for (const Image& image : {solved.elements(128), solved.gather(128).radiance}) {
    for (const int i : {0, 3}) {
      for (const int j : {0, 3}) EXPECT_NEAR(at(image, i, j), quarter(i, j), 1e-3) << i << j;
    }
  }
}

}  // namespace
}  // namespace radiosity
