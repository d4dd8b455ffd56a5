// Layers of pictures: depth of a tilted plane, and the parts of light in a furnace.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "radiosity/elements.h"
#include "radiosity/render.h"
#include "support/quad_mesh.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

const ImageLayer& layerOf(const std::vector<ImageLayer>& layers, const std::string& name) {
  for (const ImageLayer& layer : layers) {
    if (layer.name == name) return layer;
  }
  throw std::runtime_error("no layer " + name);
}

TEST(PictureLayers, ATiltedPlaneIsAsFarAsItIs) {
  constexpr int kWidth = 48;
  constexpr int kHeight = 32;
  const Vec3 u(1, 0, 0.5);
  const Vec3 v(0, 1, -0.25);
  test::QuadMesh builder;
  builder.grid("plane", -8.0 * u - 8.0 * v, 16.0 * u, 16.0 * v, 4, 4);
  const PatchMesh mesh = builder.build();
  Camera camera;
  camera.eye = {0.3, -0.2, 5};
  camera.target = {0.3, -0.2, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov = 0.9;
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  const std::vector<ImageLayer> layers = pictureLayers(mesh, camera, options, {});
  const Vec3 normal = glm::normalize(glm::cross(u, v));
  const double focal = kHeight / 2.0 / std::tan(0.45);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::size_t pixel = std::size_t(y) * kWidth + std::size_t(x);
      // The ray of the pixel's middle, one metre long along the view; the plane holds the origin.
      const Vec3 ray((x + 0.5 - kWidth / 2.0) / focal, (kHeight / 2.0 - y - 0.5) / focal, -1);
      const double depth = -glm::dot(normal, camera.eye) / glm::dot(normal, ray);
      EXPECT_NEAR(layerOf(layers, "depth").values[pixel] / depth, 1, 1e-6);  // single precision
      Vec3 n;
      for (int axis = 0; axis < 3; ++axis) {
        n[axis] = layerOf(layers, "normal").values[3 * pixel + std::size_t(axis)];
      }
      EXPECT_NEAR(glm::length(n - normal), 0, 1e-6);
      const Vec3 at = camera.eye + depth * ray;
      const auto cell = [](double place) { return int(std::floor((place + 8) / 4)); };
      const int patch = 4 * cell(at.y) + cell(at.x);  // u and v add nothing along x and y
      EXPECT_EQ(layerOf(layers, "patch").values[pixel], float(patch));
      EXPECT_EQ(layerOf(layers, "surface").values[pixel], 0.0F);
    }
  }
}

TEST(PictureLayers, DirectLightOfAFurnaceIsItsEmissionAndOneReflection) {
  // rho = .5 and E = 1 all around: B = 2, of it E + rho E at once.
  test::SceneBuilder builder;
  builder.box(builder.surface("wall", 0.5, 1.0), Vec3(0), Vec3(1), false);
  const Scene scene = builder.scene();
  Progress quiet;
  const PatchMesh mesh = meshScene(scene, {.patches = 96}, quiet).mesh;
  const PatchMaterials materials = patchMaterials(scene, mesh);
  const std::vector<double> radiosity(3 * mesh.size(), 2.0);
  SurfaceLight light = surfaceLight(radiosity, materials);
  light.reflectance = materials.reflectance;
  light.emission = materials.emission;
  Camera camera;
  camera.eye = {0.2, 0.3, 0.4};
  camera.target = {1, 0.6, 0.5};
  RenderOptions options;
  options.width = options.height = 24;
  options.samples = 2;
  light.points = std::make_shared<const LightAtPoints>(mesh, materials, radiosity, ElementOptions(),
                                                       std::span<const std::uint8_t>(), quiet);
  PictureParts gathered;
  const Image of_points =
      gatherRadiance(mesh, light, camera, options, {}, quiet, &gathered).radiance;
  light.points.reset();
  light.elements =
      std::make_shared<const Elements>(computeElements(mesh, materials, radiosity, {}, {}, quiet));
  PictureParts interpolated;
  const Image of_elements = renderRadiance(mesh, light, camera, options, quiet, &interpolated);
  const auto expect = [](const Image& image, const PictureParts& parts) {
    for (std::size_t k = 0; k < parts.direct.size(); ++k) {
      // Of 96 patches all emit: there are few enough for light by rays to them, of 1% or less.
      EXPECT_NEAR(parts.direct[k] * std::numbers::pi, 1.5, 0.02);
      EXPECT_NEAR(parts.albedo[k], 0.5, 1e-7);
      EXPECT_FLOAT_EQ(parts.direct[k] + parts.indirect[k], image.rgba[k / 3 * 4 + k % 3]);
    }
  };
  expect(of_points, gathered);
  expect(of_elements, interpolated);
  EXPECT_EQ(gathered.error.size(), gathered.direct.size() / 3);
  for (const float error : gathered.error) EXPECT_LT(error, 0.02);
  EXPECT_TRUE(interpolated.error.empty());
}

TEST(PictureLayers, FallingLightIsIrradiance) {
  test::QuadMesh builder;
  builder.grid("plate", {-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  const PatchMesh mesh = builder.build();
  PatchMaterials materials;
  materials.bands = 1;
  materials.reflectance = {0.25};
  materials.emission = {7};
  Camera camera;
  camera.eye = {0, 0, 1};
  camera.target = {0, 0, 0};
  camera.up = {0, 1, 0};
  RenderOptions options;
  options.width = options.height = 4;
  Progress quiet;
  const std::vector<double> radiosity = {8};
  const std::vector<double> irradiance = {4};
  const SurfaceLight falling =
      fallingLight(surfaceLight(radiosity, materials), irradiance, materials.bands);
  const Image image = renderRadiance(mesh, falling, camera, options, quiet);
  EXPECT_FLOAT_EQ(image.rgba[0], 4 * std::numbers::inv_pi_v<float>);
}

}  // namespace
}  // namespace radiosity
