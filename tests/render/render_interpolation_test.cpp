// Values at corners and within patches: which patches mix, and the accuracy of fields.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <random>

#include "radiosity/render.h"
#include "render/patch_shader.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

using test::QuadMesh;
using Field = std::function<double(const Vec3&)>;

/// value(i) for every patch i.
template <class Value>
std::vector<double> perPatch(const PatchMesh& mesh, Value value) {
  std::vector<double> values(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) values[i] = value(i);
  return values;
}

std::vector<double> atCentroids(const PatchMesh& mesh, const Field& field) {
  return perPatch(mesh, [&](std::size_t i) { return field(mesh.centroid[i]); });
}

TEST(CornerValues, AConstantStaysConstantToTheBit) {
  QuadMesh builder;
  builder.box("box", {0.1, 0.2, 0.3}, {1.7, 2.9, 3.1}, 7);
  builder.patch("box", {{9, 0, 0}, {10, 0, 0}, {9, 0, 0}});  // degenerate
  const PatchMesh mesh = builder.build();
  for (const double value : {0.1, 1.0 / 3, 1e-300, 7e12}) {
    const std::vector<double> values(mesh.size(), value);
    for (const double corner : cornerValues(mesh, values, 1, 180)) ASSERT_EQ(corner, value);
  }
}

TEST(CornerValues, CubeFacesDoNotBleed) {
  QuadMesh builder;
  builder.box("cube", Vec3(0), Vec3(1), 4);
  const PatchMesh mesh = builder.build();
  const std::vector<double> values = perPatch(
      mesh, [&](std::size_t i) { return std::exp2(mesh.polygon[i]); });  // no mean is a value
  const auto bleeding = [&](double crease) {
    const std::vector<double> corners = cornerValues(mesh, values, 1, crease);
    int count = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
        count += corners[c] != values[i];
      }
    }
    return count;
  };
  EXPECT_EQ(bleeding(30), 0);
  EXPECT_EQ(bleeding(89.9), 0);
  // Once 90 degrees count as smooth every corner on an edge of the cube mixes: of the 4 x 4
  // patches of a face, 4 have 3 such corners and 8 have 2.
  EXPECT_EQ(bleeding(90.1), 6 * (4 * 3 + 8 * 2));
}

TEST(CornerValues, CoplanarNeighboursOfAnotherSurfaceDoNotBleed) {
  QuadMesh builder;
  builder.grid("ceiling", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  builder.grid("lamp", {1, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  const PatchMesh mesh = builder.build();
  const std::vector<double> values =
      perPatch(mesh, [&](std::size_t i) { return mesh.surface[i] == 0 ? 0.7 : 40.0; });
  const std::vector<double> corners = cornerValues(mesh, values, 1, 180);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
      ASSERT_EQ(corners[c], values[i]);
    }
  }
}

/// A drum of `sides` quads about z, fronts outward.
PatchMesh drum(int sides, bool two_sided = false) {
  QuadMesh builder;
  std::vector<Vec3> ring;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    ring.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  for (int k = 0; k < sides; ++k) {
    const Vec3& a = ring[k];
    const Vec3& b = ring[(k + 1) % sides];
    builder.grid("drum", a, b - a, {0, 0, 1}, 1, 1, two_sided);
  }
  return builder.build();
}

TEST(CornerValues, AFineDrumIsSmoothAroundUpToTheCreaseAngle) {
  const PatchMesh mesh = drum(48);  // 7.5 degrees a side
  const std::vector<double> values = perPatch(mesh, [](std::size_t i) { return double(i); });
  const std::vector<double> smooth = cornerValues(mesh, values, 1, 8);
  // Side 5, corners 0 and 3 on the edge to side 4, 1 and 2 on that to side 6; equal areas.
  const double expected[4] = {4.5, 5.5, 5.5, 4.5};
  // The 48 areas differ by rounding: 1e-12 is far above that and far below any other answer.
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(smooth[5 * 4 + k], expected[k], 1e-12);
  const std::vector<double> sharp = cornerValues(mesh, values, 1, 7);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(sharp[5 * 4 + k], 5);
}

void expectSidesApart(const PatchMesh& mesh) {
  const std::vector<double> values =
      perPatch(mesh, [&](std::size_t i) { return mesh.side[i] ? 3.0 : 1.0; });
  for (const double crease : {30.0, 180.0}) {
    const std::vector<double> corners = cornerValues(mesh, values, 1, crease);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t c = mesh.corner_offset[i]; c < mesh.corner_offset[i + 1]; ++c) {
        ASSERT_EQ(corners[c], values[i]);
      }
    }
  }
}

TEST(CornerValues, TheSidesOfATwoSidedSheetDoNotMix) {
  expectSidesApart(drum(24, true));
  QuadMesh builder;
  builder.grid("flat", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 3, true);
  expectSidesApart(builder.build());
}

TEST(CornerValues, TheOrderOfPatchesChangesNoBit) {
  QuadMesh builder;
  builder.grid("floor", {0, 0, 0}, {1, 0.1, 0}, {0.3, 1, 0}, 12, 12);
  std::vector<std::size_t> order(builder.patchCount());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937_64(9));
  const PatchMesh mesh = builder.build();
  const PatchMesh shuffled = builder.build(order);
  const Field field = [](const Vec3& p) { return std::sin(9 * p.x) + std::exp(p.y); };
  const std::vector<double> a = cornerValues(mesh, atCentroids(mesh, field), 1, 30);
  const std::vector<double> b = cornerValues(shuffled, atCentroids(shuffled, field), 1, 30);
  for (std::size_t k = 0; k < order.size(); ++k) {
    for (std::size_t c = 0; c < 4; ++c) ASSERT_EQ(b[k * 4 + c], a[order[k] * 4 + c]);
  }
}

TEST(CornerValues, PatchesAreWeightedByArea) {
  QuadMesh builder;
  builder.patch("floor", {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}});
  builder.patch("floor", {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}});
  const PatchMesh mesh = builder.build();
  const std::vector<double> corners = cornerValues(mesh, std::vector<double>{2.0, 10.0}, 1, 30);
  EXPECT_DOUBLE_EQ(corners[1], (3 * 2.0 + 1 * 10.0) / 4);
  EXPECT_DOUBLE_EQ(corners[4], (3 * 2.0 + 1 * 10.0) / 4);
  EXPECT_EQ(corners[0], 2.0);
  EXPECT_EQ(corners[5], 10.0);
}

TEST(CornerValues, PatchesThatTouchInAVertexDoNotMix) {
  QuadMesh builder;
  builder.patch("floor", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  builder.patch("floor", {{1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}});
  const PatchMesh mesh = builder.build();
  const std::vector<double> corners = cornerValues(mesh, std::vector<double>{1.0, 2.0}, 1, 30);
  EXPECT_EQ(corners[2], 1.0);
  EXPECT_EQ(corners[4], 2.0);
}

TEST(CornerValues, WrongLengthIsRefused) {
  const PatchMesh mesh = drum(12);
  EXPECT_THROW(cornerValues(mesh, std::vector<double>(11), 1, 30), InputError);
}

/// The point of the plane z = 0 that a pixel position of `view` sees.
Vec3 onPlane(const View& view, double x, double y) {
  const Vec3 ray = view.forward + view.right * ((x - view.centre_x) / view.focal) -
                   view.up * ((y - view.centre_y) / view.focal);
  return view.eye - ray * (view.eye.z / ray.z);
}

Camera obliqueCamera() {
  Camera camera;
  camera.eye = {0.5, -0.9, 0.8};
  camera.target = {0.5, 0.45, 0};
  camera.vertical_fov = 0.9;
  return camera;
}

TEST(PatchShader, LinearFieldsComeOutExactlyInAnyQuadOrTriangle) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> shift(-0.25, 0.25);
  const Field linear = [](const Vec3& p) { return 3 + 2 * p.x - 5 * p.y; };
  const View view = makeView(obliqueCamera(), 64, 64);
  int samples = 0;
  for (int trial = 0; trial < 60; ++trial) {
    QuadMesh builder;
    std::vector<Vec3> outline = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const bool concave = trial % 3 == 2;  // by its triangles
    if (concave) outline[0] = {0.7, 0.7, 0};
    for (Vec3& v : outline) v += Vec3(shift(random), shift(random), 0) * (concave ? 0.25 : 1.0);
    if (trial % 3 == 1) outline.pop_back();
    builder.patch("quad", outline);
    const PatchMesh mesh = builder.build();
    const ItemBuffer items(mesh, view, 1, true);
    PatchField field;
    const std::vector<double> own(mesh.size(), NAN);
    field.values = own;
    for (const Index v : mesh.corners) field.corners.push_back(linear(mesh.vertices[v]));
    PatchShader shader(mesh, items, field);
    TileItems seen;
    items.resolve(0, seen);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        const Index piece = seen.piece[seen.at(x, y, 0)];
        if (piece == kNone) continue;
        shader.setPiece(piece);
        // Doubles throughout; an edge function loses up to 1e3 ulps to cancellation.
        ASSERT_NEAR(shader.at(x + 0.5, y + 0.5).value[0], linear(onPlane(view, x + 0.5, y + 0.5)),
                    1e-11);
        ++samples;
      }
    }
  }
  EXPECT_GT(samples, 10000);
}

TEST(PatchShader, ASquareIsBilinearWithoutACreaseAlongADiagonal) {
  QuadMesh builder;
  builder.grid("square", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const PatchMesh mesh = builder.build();
  const View view = makeView(obliqueCamera(), 64, 64);
  const ItemBuffer items(mesh, view, 1, true);
  PatchField field;
  const std::vector<double> own(1, 0.0);
  field.values = own;
  field.corners = {0, 1, 0, 1};  // x + y - 2xy: two triangles would give 0 or 1 along a diagonal
  PatchShader shader(mesh, items, field);
  TileItems seen;
  items.resolve(0, seen);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Index piece = seen.piece[seen.at(x, y, 0)];
      if (piece == kNone) continue;
      shader.setPiece(piece);
      const Vec3 p = onPlane(view, x + 0.5, y + 0.5);
      // The same ulps as above.
      ASSERT_NEAR(shader.at(x + 0.5, y + 0.5).value[0], p.x + p.y - 2 * p.x * p.y, 1e-11);
    }
  }
}

/// Largest error of the picture of `field` over an n x n grid of the unit square, at samples whose
/// distance to the square's border is at least `margin`.
double pictureError(int n, const Field& field, double margin) {
  QuadMesh builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  const PatchMesh mesh = builder.build();
  const std::vector<double> scalar = atCentroids(mesh, field);
  std::vector<double> values;
  for (const double v : scalar) values.insert(values.end(), {v, v, v});
  RenderOptions options;
  options.width = options.height = 256;
  options.samples = 1;
  Progress silent;
  const Image image = render(mesh, values, obliqueCamera(), options, silent);
  const View view = makeView(obliqueCamera(), 256, 256);
  double worst = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const float* pixel = image.rgba.data() + (y * 256 + x) * 4;
      if (pixel[3] == 0) continue;
      const Vec3 p = onPlane(view, x + 0.5, y + 0.5);
      const double border = std::min({p.x, p.y, 1 - p.x, 1 - p.y});
      if (border >= margin) worst = std::max(worst, std::abs(pixel[0] - field(p)));
    }
  }
  return worst;
}

TEST(InterpolatedPicture, ALinearFieldIsReproducedAwayFromTheBorder) {
  const Field linear = [](const Vec3& p) { return 1 + 2 * p.x + 3 * p.y; };
  // Inner corners are means over four equal patches: exact. What is left is the float of the
  // picture, 6e-8 of values up to 6.
  for (const int n : {4, 8, 32}) EXPECT_LT(pictureError(n, linear, 1.0 / n), 4e-7) << n;
}

TEST(InterpolatedPicture, TheBorderIsFirstOrderAndTheInsideSecond) {
  // A corner on the border is a mean over patches on one side of it: half a patch too far inside,
  // so the error of a linear field there is slope * h / 2 in each direction, and halves with h.
  const Field linear = [](const Vec3& p) { return 1 + 2 * p.x + 3 * p.y; };
  const double coarse = pictureError(8, linear, 0);
  const double fine = pictureError(16, linear, 0);
  // The worst point is the square's very corner, (2 + 3) h / 2; pixels come near it.
  EXPECT_NEAR(coarse, 5.0 / 16, 0.03);
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.15);
  // Inside, means and bilinear interpolation of a curved field are both wrong by h^2 f'' / 8-like
  // terms: order 2. The worst sample wanders over the cells, hence the width.
  const Field curved = [](const Vec3& p) { return std::sin(5 * p.x) * std::cos(4 * p.y); };
  const double error16 = pictureError(16, curved, 0.13);
  const double error32 = pictureError(32, curved, 0.13);
  EXPECT_NEAR(std::log2(error16 / error32), 2, 0.2);
}

TEST(InterpolatedPicture, AConstantFieldIsConstantInEveryPixelHit) {
  QuadMesh builder;
  builder.box("room", {-2, 0, -3}, {2, 2.5, 3}, 7, true);
  builder.box("block", {-1, 0.25, -1.5}, {0, 1.5, -0.5}, 3);
  builder.grid("sheet", {0.5, 0.5, -2}, {1, 0, 0.3}, {0, 1, 0}, 3, 3, true);
  const PatchMesh mesh = builder.build();
  std::vector<double> values;
  for (std::size_t i = 0; i < mesh.size(); ++i) values.insert(values.end(), {0.1, 1.0 / 3, 170.3});
  Camera camera;
  camera.eye = {0.3, 1.1, 9};  // outside: some pixels hit nothing, some partly
  camera.target = {0, 1, 0};
  for (const bool smooth : {true, false}) {
    for (const int samples : {1, 3, 4}) {
      RenderOptions options;
      options.width = 120;
      options.height = 90;
      options.samples = samples;
      options.smooth = smooth;
      options.show_backs = false;
      Progress silent;
      const Image image = render(mesh, values, camera, options, silent);
      int partial = 0;
      for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
        const float alpha = image.rgba[k + 3];
        partial += alpha > 0 && alpha < 1;
        ASSERT_EQ(image.rgba[k], alpha > 0 ? 0.1f : 0);
        ASSERT_EQ(image.rgba[k + 1], alpha > 0 ? float(1.0 / 3) : 0);
        ASSERT_EQ(image.rgba[k + 2], alpha > 0 ? 170.3f : 0);
      }
      EXPECT_EQ(partial > 0, samples > 1);
    }
  }
}

}  // namespace
}  // namespace radiosity
