// Skies behind a picture: each pixel shows the radiance of its direction.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/render.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

// A camera that looks level to the north, -z; a pixel's direction by hand.
TEST(SkyPicture, PixelsShowTheRadianceOfTheirDirection) {
  test::SceneBuilder builder;
  builder.face(builder.surface("far below"), {{0, -90, 0}, {0, -90, 1}, {1, -90, 1}, {1, -90, 0}});
  Progress quiet;
  const PatchMesh mesh = meshScene(builder.scene(), {.patches = 1}, quiet).mesh;
  PatchMaterials materials;
  materials.bands = 3;
  materials.reflectance.assign(3 * mesh.size(), 0.0);
  materials.emission.assign(3 * mesh.size(), 0.0);
  materials.lights = {lightOf("cie-sky,7,14,21,type=16")};
  materials.lights[0].settle(Up::y);
  const SurfaceLight light = surfaceLight(std::vector<double>(3 * mesh.size(), 0.0), materials);
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.target = {0, 0, 0};
  camera.vertical_fov = std::numbers::pi / 2;
  RenderOptions options;
  options.width = options.height = 8;
  options.samples = 1;
  const Image image = renderRadiance(mesh, light, camera, options, quiet);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const double across = (x + 0.5) / 4 - 1;
      const double up = 1 - (y + 0.5) / 4;
      const double sine = up / std::sqrt(1 + across * across + up * up);
      const double zenith = 7 * 9 / (7 * std::numbers::pi);
      const double radiance = sine > 0 ? zenith * (1 + 2 * sine) / 3 : 0;
      for (int b = 0; b < 3; ++b) {
        // Single precision, and the quadrature of the sky.
        EXPECT_NEAR(image.rgba[std::size_t(4 * (8 * y + x) + b)], (b + 1) * radiance, 1e-4)
            << x << ", " << y;
      }
      EXPECT_EQ(image.rgba[std::size_t(4 * (8 * y + x) + 3)], 1);
    }
  }
}

}  // namespace
}  // namespace radiosity
