// Visible surfaces: coverage, perspective, depth order, sides, clipping, and equal bits.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "radiosity/render.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

using test::QuadMesh;

/// A camera at `eye` looking along -z unless told otherwise, with tan(fov / 2) = 1/2.
Camera cameraAt(Vec3 eye, Vec3 direction = {0, 0, -1}) {
  Camera camera;
  camera.eye = eye;
  camera.target = eye + direction;
  camera.vertical_fov = 2 * std::atan(0.5);
  return camera;
}

RenderOptions sized(int width, int height, int samples = 4) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  return options;
}

Image picture(const PatchMesh& mesh, const std::vector<double>& values, const Camera& camera,
              const RenderOptions& options) {
  Progress silent;
  return render(mesh, values, camera, options, silent);
}

/// Value k + 1 in the first band of patch k, which tells the patches of a flat picture.
std::vector<double> labels(const PatchMesh& mesh) {
  std::vector<double> values(mesh.size() * 3, 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) values[i * 3] = double(i + 1);
  return values;
}

const float* pixel(const Image& image, int x, int y) {
  return image.rgba.data() + (std::size_t(y) * image.width + x) * 4;
}

double coverage(const Image& image) {
  double sum = 0;
  for (std::size_t k = 3; k < image.rgba.size(); k += 4) sum += image.rgba[k];
  return sum;
}

PatchMesh furnishedRoom(int n) {
  QuadMesh builder;
  builder.box("room", {-2, 0, -3}, {2, 2.5, 3}, n, true);
  builder.box("block", {-1, 0.25, -1.5}, {0, 1.5, -0.5}, 2);
  return builder.build();
}

TEST(RenderVisibility, AxisAlignedSquareCoversItsProjectedArea) {
  QuadMesh builder;
  builder.grid("square", {-0.31, -0.27, 0}, {0.7, 0, 0}, {0, 0.55, 0}, 3, 2);
  const PatchMesh mesh = builder.build();
  const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 2}), sized(160, 120));
  // tan(fov/2) = 1/2: 120 pixels are 2 m at distance 2, 60 pixels a metre.
  const double exact = 0.7 * 60 * 0.55 * 60;
  // The 16 samples of a pixel stand at 16 equally spaced x and y: a straight edge is off by at
  // most 1/32 pixel along its length; the four corner pixels may each be wrong by less than 1/4.
  EXPECT_NEAR(coverage(image), exact, 2 * (42 + 33) / 32.0 + 1);
  EXPECT_EQ(pixel(image, 80, 60)[3], 1.0f);
  EXPECT_EQ(pixel(image, 0, 0)[3], 0.0f);
}

TEST(RenderVisibility, TiltedSquareCoversItsProjectedArea) {
  // Corners at depths 2 -+ 0.8: the projection is a trapezium; its area by the shoelace formula.
  QuadMesh builder;
  builder.grid("square", {-0.5, -0.5, -0.8}, {1, 0.1, 0}, {0.1, 1, 1.6}, 1, 1);
  const PatchMesh mesh = builder.build();
  const int size = 200;
  const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 2}), sized(size, size));
  std::vector<Vec2> seen;
  for (const Index v : mesh.outline(0)) {
    const Vec3 p = mesh.vertices[v] - Vec3(0, 0, 2);
    seen.emplace_back(size / 2.0 + size * p.x / -p.z, size / 2.0 - size * p.y / -p.z);
  }
  double twice = 0;
  double perimeter = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& a = seen[k];
    const Vec2& b = seen[(k + 1) % 4];
    twice += a.x * b.y - b.x * a.y;
    perimeter += glm::length(b - a);
  }
  // An oblique edge crosses the 4 x 4 samples of its pixels in ever new places; errors of up to
  // 1/4 pixel are independent and average out as the root of the number of pixels crossed.
  EXPECT_NEAR(coverage(image), std::abs(twice) / 2, 0.25 * std::sqrt(perimeter));
}

TEST(RenderVisibility, APointIsSeenAtItsPerspectivePlace) {
  // A square of 0.2 m around (0.4, 0.3, -1), seen from an oblique camera.
  const Vec3 point(0.4, 0.3, -1.0);
  Camera camera = cameraAt({1.5, 1.0, 2.0});
  camera.target = {0.1, 0.2, 0};
  camera.up = {0.2, 1, 0};
  const Vec3 w = glm::normalize(camera.target - camera.eye);
  const Vec3 r = glm::normalize(glm::cross(w, camera.up));
  const Vec3 u = glm::cross(r, w);
  QuadMesh builder;
  builder.grid("dot", point - 0.1 * r - 0.1 * u, 0.2 * r, 0.2 * u);
  const PatchMesh mesh = builder.build();
  const Image image = picture(mesh, labels(mesh), camera, sized(400, 300, 16));
  Vec2 centre(0.0);
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 400; ++x) centre += Vec2(x + 0.5, y + 0.5) * double(pixel(image, x, y)[3]);
  }
  centre /= coverage(image);
  const Vec3 d = point - camera.eye;
  const double focal = 300;  // pixels: height / (2 tan(fov / 2))
  // The centre of a square parallel to the picture is the centre of its image, 18 pixels wide. A
  // partly covered pixel counts at its centre, wrong by f (1 - f) / 2 <= 1/8 pixel squared at each
  // end: 2/8 / 18 = 0.014; the 256 samples add less than 1/512.
  EXPECT_NEAR(centre.x, 200 + focal * glm::dot(d, r) / glm::dot(d, w), 0.017);
  EXPECT_NEAR(centre.y, 150 - focal * glm::dot(d, u) / glm::dot(d, w), 0.017);
}

/// Distance along the ray to a triangle, or infinity (Moller & Trumbore 1997): knows nothing of
/// pixels, edges or planes.
double cast(const Vec3& eye, const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = glm::cross(ray, ac);
  const double det = glm::dot(ab, p);
  const Vec3 s = eye - a;
  const double u = glm::dot(s, p) / det;
  const Vec3 q = glm::cross(s, ab);
  const double v = glm::dot(ray, q) / det;
  const double t = glm::dot(ac, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

TEST(RenderVisibility, TriangleSoupAroundTheEyeAgreesWithRays) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  const auto point = [&] { return Vec3(anywhere(random), anywhere(random), anywhere(random)); };
  for (int soup = 0; soup < 6; ++soup) {
    QuadMesh builder;
    for (int k = 0; k < 40; ++k) {
      builder.patch("soup", {point(), point(), point()}, true);  // many pass beside the eye
    }
    const PatchMesh mesh = builder.build();
    RenderOptions options = sized(90, 70, 1);
    options.smooth = false;
    const Camera camera = cameraAt({0, 0, 0}, point());
    const Image image = picture(mesh, labels(mesh), camera, options);
    const Vec3 w = glm::normalize(camera.target - camera.eye);
    const Vec3 r = glm::normalize(glm::cross(w, camera.up));
    const Vec3 u = glm::cross(r, w);
    int hits = 0;
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        const Vec3 ray = w + r * ((x + 0.5 - 45) / 70) - u * ((y + 0.5 - 35) / 70);
        double nearest = INFINITY;
        std::size_t expected = 0;
        for (std::size_t i = 0; i < mesh.size(); ++i) {
          const auto& [a, b, c] = mesh.pieces[i];
          if (glm::dot(mesh.normal[i], ray) > 0) continue;  // the twin faces the ray
          const double t =
              cast(camera.eye, ray, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
          if (t < nearest) {
            nearest = t;
            expected = i + 1;
          }
        }
        hits += expected > 0;
        ASSERT_EQ(pixel(image, x, y)[0], float(expected))
            << "soup " << soup << " " << x << "," << y;
      }
    }
    EXPECT_GT(hits, 1000) << "the soup should fill a good part of the picture";
  }
}

TEST(RenderVisibility, AHugeFloorThatPassesBehindTheEyeEndsAtTheHorizon) {
  QuadMesh builder;
  builder.grid("floor", {-1e6, 0, 1e6}, {2e6, 0, 0}, {0, 0, -2e6});
  const PatchMesh mesh = builder.build();
  const Image image = picture(mesh, labels(mesh), cameraAt({0.3, 1, 0.2}), sized(64, 64));
  // The far edge lies 64 / 1e6 pixels under the middle, above the first sample row at 1/32 pixel.
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) ASSERT_EQ(pixel(image, x, y)[3], y < 32 ? 0.0f : 1.0f) << y;
  }
}

TEST(RenderVisibility, ASurfaceCloseToTheEyeIsDrawn) {
  // 1e-9 m before the eye of a room of metres: a near plane would open it.
  QuadMesh builder;
  builder.grid("near", {-1, -1, -1e-9}, {2, 0, 0}, {0, 2, 0});
  builder.grid("far", {-9, -9, -5}, {18, 0, 0}, {0, 18, 0});
  const PatchMesh mesh = builder.build();
  RenderOptions options = sized(32, 32);
  options.smooth = false;
  const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), options);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(pixel(image, k, k)[0], 1.0f);
}

TEST(RenderVisibility, NearerSurfacesHideFartherOnesInAnyOrder) {
  for (const bool near_first : {true, false}) {
    QuadMesh builder;
    const auto add = [&](double z, double half) {
      builder.grid("s", {-half, -half, z}, {2 * half, 0, 0}, {0, 2 * half, 0});
    };
    near_first ? add(-2, 0.2) : add(-4, 3);
    near_first ? add(-4, 3) : add(-2, 0.2);
    const PatchMesh mesh = builder.build();
    RenderOptions options = sized(64, 64);
    options.smooth = false;
    const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), options);
    EXPECT_EQ(pixel(image, 32, 32)[0], near_first ? 1.0f : 2.0f);
    EXPECT_EQ(pixel(image, 2, 2)[0], near_first ? 2.0f : 1.0f);
  }
}

TEST(RenderVisibility, EqualDepthsGoToTheSurfaceFirstByName) {
  for (const bool first : {true, false}) {
    QuadMesh builder;
    builder.grid(first ? "a" : "b", {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
    builder.grid(first ? "b" : "a", {-1, -1, -2}, {2, 0, 0}, {0, 2, 0});
    const PatchMesh mesh = builder.build();
    RenderOptions options = sized(8, 8);
    options.smooth = false;
    const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), options);
    EXPECT_EQ(pixel(image, 4, 4)[0], first ? 1.0f : 2.0f);
  }
}

TEST(RenderVisibility, BacksAreBlackOrTransparent) {
  QuadMesh builder;
  builder.grid("away", {-1, -1, -2}, {0, 2, 0}, {2, 0, 0});  // front towards -z
  const PatchMesh mesh = builder.build();
  RenderOptions options = sized(8, 8);
  options.show_backs = true;
  const Image shown = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), options);
  EXPECT_EQ(pixel(shown, 4, 4)[0], 0.0f);
  EXPECT_EQ(pixel(shown, 4, 4)[3], 1.0f);
  options.show_backs = false;
  const Image hidden = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), options);
  EXPECT_EQ(pixel(hidden, 4, 4)[3], 0.0f);
}

TEST(RenderVisibility, TwoSidedPatchesShowTheValueOfTheSideSeen) {
  QuadMesh builder;  // oblique: the depths of both sides differ by rounding errors
  builder.grid("sheet", {-1, -1, 0.1}, {2, 0.1, -0.3}, {0.2, 2, 0.7}, 1, 1, true);
  const PatchMesh mesh = builder.build();
  ASSERT_EQ(mesh.size(), 2u);
  for (const bool backs : {true, false}) {
    RenderOptions options = sized(48, 48);
    options.show_backs = backs;
    const Image front = picture(mesh, labels(mesh), cameraAt({0, 0, 4}), options);
    const Image back = picture(mesh, labels(mesh), cameraAt({0, 0, -4}, {0, 0, 1}), options);
    EXPECT_GT(coverage(front), 200);
    for (std::size_t k = 0; k < front.rgba.size(); k += 4) {
      ASSERT_EQ(front.rgba[k], front.rgba[k + 3] > 0 ? 1.0f : 0.0f);
      ASSERT_EQ(back.rgba[k], back.rgba[k + 3] > 0 ? 2.0f : 0.0f);
    }
  }
}

TEST(RenderVisibility, SamplesExactlyOnASharedEdgeAreCovered) {
  // The common edge runs through pixel centres, along a diagonal or a column, and is any of the
  // edges of either triangle.
  for (const bool diagonal : {true, false}) {
    const Vec3 from(diagonal ? -1 : 0, -1, -1);
    const Vec3 to(diagonal ? 1 : 0, 1, -1);
    const Vec3 left(-3, 1, -1);
    const Vec3 right(3, -1, -1);
    for (int turn = 0; turn < 9; ++turn) {
      std::vector<Vec3> one = {from, to, left};
      std::vector<Vec3> other = {to, from, right};
      std::rotate(one.begin(), one.begin() + turn % 3, one.end());
      std::rotate(other.begin(), other.begin() + turn / 3, other.end());
      QuadMesh builder;
      builder.patch("s", one);
      builder.patch("s", other);
      const PatchMesh mesh = builder.build();
      const Image image = picture(mesh, labels(mesh), cameraAt({0, 0, 0}), sized(15, 15, 1));
      for (int k = 0; k < 15; ++k) {
        ASSERT_EQ(pixel(image, diagonal ? k : 7, 14 - k)[3], 1.0f) << turn << " " << k;
      }
    }
  }
}

TEST(RenderVisibility, FromInsideASolidOnlyBacksAreSeen) {
  QuadMesh builder;
  builder.box("solid", Vec3(-1), Vec3(1), 3);
  const PatchMesh mesh = builder.build();
  RenderOptions options = sized(32, 32);
  options.show_backs = true;
  const Image black = picture(mesh, labels(mesh), cameraAt({0.1, 0.2, 0.3}), options);
  EXPECT_EQ(coverage(black), 32 * 32);
  EXPECT_EQ(pixel(black, 7, 9)[0], 0.0f);
  options.show_backs = false;
  EXPECT_EQ(coverage(picture(mesh, labels(mesh), cameraAt({0.1, 0.2, 0.3}), options)), 0);
}

TEST(RenderVisibility, ARoomHasNoCracks) {
  // From eyes on the planes of symmetry and grid lines too, where samples fall exactly on edges.
  const PatchMesh mesh = furnishedRoom(13);
  const std::vector<double> values = labels(mesh);
  for (const Vec3& eye : {Vec3(0.0, 1.25, 2.9), Vec3(0.5, 1.25, 1), Vec3(1.99, 2.49, 2.99)}) {
    for (const Vec3& direction : {Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(-0.31, -0.2, 0.7)}) {
      for (const int samples : {1, 4}) {
        RenderOptions options = sized(63, 63, samples);
        options.show_backs = false;
        const Image image = picture(mesh, values, cameraAt(eye, direction), options);
        ASSERT_EQ(coverage(image), 63 * 63);
      }
    }
  }
}

TEST(RenderVisibility, ThreadsOrderAndPowersOfTwoChangeNoBit) {
  QuadMesh builder;
  builder.box("room", {-2, 0, -3}, {2, 2.5, 3}, 9, true);
  builder.box("block", {-1, 0, -1.5}, {0, 1.5, -0.5}, 4);  // stands on the floor: equal depths
  builder.grid("sheet", {0.5, 0.5, -2}, {1, 0, 0.3}, {0, 1, 0}, 3, 3, true);
  const PatchMesh mesh = builder.build();
  std::vector<std::size_t> order(builder.patchCount());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937_64(3));
  const PatchMesh shuffled = builder.build(order);

  const auto values = [](const PatchMesh& m) {
    std::vector<double> v;
    for (std::size_t i = 0; i < m.size(); ++i) {
      const Vec3 c = m.centroid[i];
      for (int b = 0; b < 3; ++b) v.push_back(1.5 + std::sin(7 * c.x + c.y * b) + m.side[i] - c.z);
    }
    return v;
  };
  Camera camera = cameraAt({0.3, 1.1, 2.7});
  camera.target = {-0.2, 1, 0};
  const RenderOptions options = sized(200, 140);
  const Image reference = picture(mesh, values(mesh), camera, options);
  EXPECT_EQ(picture(shuffled, values(shuffled), camera, options).rgba, reference.rgba);
  setThreads(1);
  const Image one = picture(mesh, values(mesh), camera, options);
  setThreads(0);
  EXPECT_EQ(one.rgba, reference.rgba);

  for (const double scale : {std::exp2(-20), std::exp2(20)}) {
    PatchMesh scaled = mesh;
    for (Vec3& v : scaled.vertices) v *= scale;
    for (double& a : scaled.area) a *= scale * scale;
    Camera moved = camera;
    moved.eye *= scale;
    moved.target *= scale;
    EXPECT_EQ(picture(scaled, values(mesh), moved, options).rgba, reference.rgba) << scale;
  }
}

TEST(RenderVisibility, SamplesSetTheStepsOfAlpha) {
  // An edge a quarter of the way through pixel column 9 of 16: alpha there is 3/4 of the samples.
  QuadMesh builder;
  builder.grid("half", {(0.5 * 5 / 16) / 4, -9, -1}, {9, 0, 0}, {0, 18, 0});
  const PatchMesh mesh = builder.build();
  Camera camera = cameraAt({0, 0, 0});
  camera.vertical_fov = 2 * std::atan(0.25);  // 16 pixels are half a metre at distance 1
  const Image one = picture(mesh, labels(mesh), camera, sized(16, 16, 1));
  const Image sixteen = picture(mesh, labels(mesh), camera, sized(16, 16, 4));
  // x = 5/128 m = 1.25 pixels right of the middle: column 9 is covered from 1/4 on.
  EXPECT_EQ(pixel(one, 9, 8)[3], 1.0f);
  EXPECT_EQ(pixel(sixteen, 9, 8)[3], 0.75f);
  EXPECT_EQ(pixel(sixteen, 8, 8)[3], 0.0f);
  EXPECT_EQ(pixel(sixteen, 10, 8)[3], 1.0f);
}

}  // namespace
}  // namespace radiosity
