// Light gathered at vertices, as pictures and lit meshes: values at corners, not means over
// patches.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "gather_scenes.h"
#include "radiosity/render.h"
#include "radiosity/results.h"
#include "support/quad_mesh.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

using test::QuadMesh;

RenderOptions small(int samples) {
  RenderOptions options;
  options.width = 60;
  options.height = 40;
  options.samples = samples;
  return options;
}

/// B = 2 + x - 3y, twice and three times that, at the corners.
Vec3 field(const Vec3& p) { return Vec3(1, 2, 3) * (2 + p.x - 3 * p.y); }

std::vector<double> atCorners(const PatchMesh& mesh) {
  std::vector<double> values;
  for (const Index v : mesh.corners) {
    const Vec3 b = field(mesh.vertices[v]);
    values.insert(values.end(), {b.x, b.y, b.z});
  }
  return values;
}

std::vector<double> atCentroids(const PatchMesh& mesh) {
  std::vector<double> values;
  for (const Vec3& c : mesh.centroid) {
    const Vec3 b = field(c);
    values.insert(values.end(), {b.x, b.y, b.z});
  }
  return values;
}

/// A sheet in the plane z = 0 that fills the view, and a camera that sees it at a slant.
PatchMesh sheet() {
  QuadMesh builder;
  builder.grid("sheet", {-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, 5, 4);
  return builder.build();
}
Camera slanted() { return parseCamera("eye=0.2,-1.2,2;target=0,0.1,0;up=0,1,0;fov=40"); }

/// The point of z = 0 seen through a pixel's middle.
Vec3 seenAt(int x, int y, const RenderOptions& options) {
  const Camera camera = slanted();
  const Vec3 ahead = glm::normalize(camera.target - camera.eye);
  const Vec3 right = glm::normalize(glm::cross(ahead, camera.up));
  const Vec3 up = glm::cross(right, ahead);
  const double half = std::tan(camera.vertical_fov / 2);
  const double pixel = 2 * half / options.height;
  const Vec3 ray = ahead + right * ((x + 0.5 - options.width / 2.0) * pixel) -
                   up * ((y + 0.5 - options.height / 2.0) * pixel);
  return camera.eye - ray * (camera.eye.z / ray.z);
}

TEST(PicturesFromCorners, ShowALinearFieldExactly) {
  const PatchMesh mesh = sheet();
  Progress quiet;
  const RenderOptions options = small(1);
  const Image image = render(mesh, atCentroids(mesh), atCorners(mesh), slanted(), options, quiet);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float* pixel =
          image.rgba.data() + 4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
      const Vec3 truth = field(seenAt(x, y, options));
      ASSERT_EQ(pixel[3], 1.0F);
      // Pixels are floats, of values up to 30.
      for (int b = 0; b < 3; ++b) ASSERT_NEAR(pixel[b], truth[b], 1e-5) << x << " " << y;
    }
  }
}

TEST(PicturesFromCorners, EqualUsualPicturesForTheUsualCornerMeans) {
  const test::Room room = test::loadRoom("cornell-box", 80);
  const std::vector<double> values = atCentroids(room.mesh);
  const std::vector<double> corners = cornerValues(room.mesh, values, 3, 30);
  Progress quiet;
  RenderOptions options = small(2);
  const Camera camera = framingCamera(room.mesh, false, 1.5);
  const Image usual = render(room.mesh, values, camera, options, quiet);
  EXPECT_EQ(render(room.mesh, values, corners, camera, options, quiet).rgba, usual.rgba);
  options.smooth = false;
  const Image flat = render(room.mesh, values, camera, options, quiet);
  EXPECT_EQ(render(room.mesh, values, corners, camera, options, quiet).rgba, flat.rgba);
  EXPECT_NE(flat.rgba, usual.rgba);
}

class GatherMeshes : public FolderTest {};

TEST_F(GatherMeshes, LitMeshHoldsTheCornersValues) {
  const PatchMesh mesh = sheet();
  writeLitGlb(path("g.glb"), mesh, atCentroids(mesh), atCorners(mesh), 0.0);
  const LitMesh lit = readLitMesh(path("g.glb"));
  ASSERT_EQ(lit.triangles.size(), 2 * mesh.size());
  for (std::size_t t = 0; t < lit.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 truth = field(lit.vertices[lit.triangles[t][k]]);
      EXPECT_LT(glm::distance(lit.colours[t][k], truth), 1e-5);  // floats of up to 42
    }
  }
}

TEST_F(GatherMeshes, WrongValuesAreRefused) {
  const PatchMesh mesh = sheet();
  Progress quiet;
  const std::vector<double> centroids = atCentroids(mesh);
  std::vector<double> corners = atCorners(mesh);
  corners[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(writeLitGlb(path("g.glb"), mesh, centroids, corners, 0.0), RunError);
  EXPECT_THROW(render(mesh, centroids, corners, slanted(), small(1), quiet), InputError);
  corners.pop_back();
  EXPECT_THROW(writeLitGlb(path("g.glb"), mesh, centroids, corners, 0.0), InputError);
  EXPECT_THROW(render(mesh, centroids, corners, slanted(), small(1), quiet), InputError);
}

}  // namespace
}  // namespace radiosity
