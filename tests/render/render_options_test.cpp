// Options that render() takes and refuses, and its smallest cases.
#include <gtest/gtest.h>

#include <cmath>

#include "radiosity/render.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

using test::QuadMesh;

Image picture(const PatchMesh& mesh, const std::vector<double>& values, int width, int height) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  Camera camera;
  camera.eye = {0, 0, 2};
  Progress silent;
  return render(mesh, values, camera, options, silent);
}

PatchMesh room() {
  QuadMesh builder;
  builder.box("room", Vec3(-3), Vec3(3), 2, true);
  return builder.build();
}

TEST(RenderOptions, OnePixelIsAPicture) {
  const PatchMesh mesh = room();
  const Image image = picture(mesh, std::vector<double>(mesh.size() * 3, 0.7), 1, 1);
  EXPECT_EQ(image.rgba, (std::vector<float>{0.7f, 0.7f, 0.7f, 1.0f}));
}

TEST(RenderOptions, AnEmptyMeshIsAllMisses) {
  const Image image = picture(QuadMesh().build(), {}, 20, 10);
  EXPECT_EQ(image.rgba, std::vector<float>(20 * 10 * 4, 0.0f));
}

TEST(RenderOptions, CancellingThrows) {
  const PatchMesh mesh = room();
  const std::vector<double> values(mesh.size() * 3, 0.7);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(render(mesh, values, Camera(), RenderOptions(), progress), Cancelled);
}

TEST(RenderOptions, RangesAreEnforced) {
  EXPECT_NO_THROW(RenderOptions().validate());
  const auto refuses = [](auto change) {
    RenderOptions options;
    change(options);
    EXPECT_THROW(options.validate(), InputError);
  };
  refuses([](RenderOptions& o) { o.width = 0; });
  refuses([](RenderOptions& o) { o.width = 16385; });
  refuses([](RenderOptions& o) { o.height = -1; });
  refuses([](RenderOptions& o) { o.height = 16385; });
  refuses([](RenderOptions& o) { o.samples = 0; });
  refuses([](RenderOptions& o) { o.samples = 17; });
  refuses([](RenderOptions& o) { o.crease = -1; });
  refuses([](RenderOptions& o) { o.crease = NAN; });
}

TEST(RenderOptions, BadValuesAreNamed) {
  const PatchMesh mesh = room();
  std::vector<double> values(mesh.size() * 3, 1.0);
  values[7] = NAN;
  try {
    picture(mesh, values, 8, 8);
    ADD_FAILURE() << "a NaN was drawn";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("patch 2 "), std::string::npos) << error.what();
  }
  values.pop_back();
  EXPECT_THROW(picture(mesh, values, 8, 8), InputError);
}

TEST(RenderOptions, ThreeBandsAreColoursAndOneIsGrey) {
  const std::vector<double> rgb = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(rgbOf(rgb, 3), rgb);
  EXPECT_EQ(rgbOf(std::vector<double>{1, 2}, 1), (std::vector<double>{1, 1, 1, 2, 2, 2}));
  for (const int bands : {0, 2, 5, 8}) {
    try {
      rgbOf(rgb, bands);
      ADD_FAILURE() << bands << " bands were made colours";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("draws three bands"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("pick one or three"), std::string::npos);
    }
  }
  const PatchMesh mesh = room();
  try {
    picture(mesh, std::vector<double>(8 * mesh.size(), 1.0), 8, 8);
    ADD_FAILURE() << "eight bands were drawn";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("a picture draws three bands"), std::string::npos);
  }
}

}  // namespace
}  // namespace radiosity
