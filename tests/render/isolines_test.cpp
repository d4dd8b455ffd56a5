// Lines at round numbers: where they are, how smooth, and where they end.
#include "render/isolines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radiosity/render.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

constexpr int kSize = 96;

/// A grey picture on which lines have been drawn, black or white; how much of them a pixel has.
class Drawn {
 public:
  Drawn(const std::vector<double>& values, const ColourRange& range, double step, int scale = 1,
        const std::function<bool(std::size_t, std::size_t)>& joined = {}) {
    image_ = {kSize, kSize, std::vector<float>(std::size_t(kSize) * kSize * 4, 0.5F)};
    drawIsolines(image_, 0, 0, {kSize, kSize, values, joined}, range, step, ColourMap(), scale,
                 false);
  }
  double ink(int x, int y) const {
    return 2 * std::abs(image_.rgba[std::size_t(y * kSize + x) * 4] - 0.5);
  }
  double allInk() const {
    double sum = 0;
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) sum += ink(x, y);
    }
    return sum;
  }
  /// The middle of the line along a row, from pixel `first` on.
  double middle(int y, int first) const {
    double sum = 0;
    double moment = 0;
    for (int x = first; x < kSize; ++x) {
      sum += ink(x, y);
      moment += ink(x, y) * (x + 0.5);
    }
    return moment / sum;
  }

 private:
  Image image_;
};

/// A value of every pixel's middle.
std::vector<double> fieldOf(const std::function<double(double, double)>& value) {
  std::vector<double> values;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) values.push_back(value(x + 0.5, y + 0.5));
  }
  return values;
}

TEST(Isolines, StepsAreRoundAndAboutTen) {
  const auto step = [](double low, double high) { return isolineStep({low, high}); };
  EXPECT_DOUBLE_EQ(step(0, 100), 10);
  EXPECT_DOUBLE_EQ(step(3, 412), 50);
  EXPECT_DOUBLE_EQ(step(0.001, 0.0029), 0.0002);
  EXPECT_EQ(step(5, 5), 0);
  EXPECT_EQ(step(5, 5 * (1 + 1e-15)), 0);
  const ColourRange out = roundedOut({3, 412, true, true}, 50);
  EXPECT_EQ(out.low, 0);
  EXPECT_EQ(out.high, 450);
  EXPECT_TRUE(out.below && out.above);
}

TEST(Isolines, ACircleIsSmooth) {
  // Distance from the corner: the line of 60 is a circle, also between the middles of pixels.
  const Drawn drawn(fieldOf([](double x, double y) { return std::hypot(x, y); }), {59, 75}, 60);
  for (int y = 0; y < 40; ++y) {
    // The chord over a pixel and the grid of a pixel's cover leave less than a tenth of a pixel.
    EXPECT_NEAR(drawn.middle(y, 0), std::sqrt(3600 - (y + 0.5) * (y + 0.5)), 0.1) << y;
  }
}

TEST(Isolines, AreAtMultiplesWithinTheRange) {
  // Four pixels a unit: lines of 5, 10, 15 at pixels 20, 40, 60 and none beyond.
  const Drawn drawn(fieldOf([](double x, double) { return x / 4; }), {1, 19}, 5, 2);
  for (const int line : {20, 40, 60}) {
    for (const int x : {line - 1, line}) EXPECT_GT(drawn.ink(x, 50), 0.9) << x;
    for (const int x : {line - 3, line + 2}) EXPECT_EQ(drawn.ink(x, 50), 0) << x;
  }
  EXPECT_EQ(drawn.ink(80, 50), 0);
}

TEST(Isolines, EndWhereSurfacesDo) {
  const auto half = [](std::size_t pixel) { return pixel % kSize < kSize / 2; };
  std::vector<double> values =
      fieldOf([](double x, double) { return x < kSize / 2.0 ? 1.0 : 9.0; });
  const ColourRange range{0, 10};
  EXPECT_GT(Drawn(values, range, 5).allInk(), kSize / 2);
  EXPECT_EQ(
      Drawn(values, range, 5, 1, [&](std::size_t a, std::size_t b) { return half(a) == half(b); })
          .allInk(),
      0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!half(k)) values[k] = std::numeric_limits<double>::quiet_NaN();
  }
  EXPECT_EQ(Drawn(values, range, 5).allInk(), 0);
}

/// Two plates of different values that fill the picture, seen from the front.
TEST(FalseColourPicture, HasNoLineBetweenSurfacesButLabelsOnThem) {
  test::QuadMesh builder;
  builder.grid("left", {-2, -2, 0}, {2, 0, 0}, {0, 4, 0});
  builder.grid("right", {0, -2, 0}, {2, 0, 0}, {0, 4, 0});
  const PatchMesh mesh = builder.build();
  Camera camera;
  camera.eye = {0, 0, 2};
  camera.target = {0, 0, 0};
  camera.up = {0, 1, 0};
  camera.vertical_fov = 1;
  RenderOptions options;
  options.width = options.height = 200;
  const auto draw = [&](double left, double right, double slope) {
    std::vector<double> values;
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) values.push_back((x < 100 ? left : right) + slope * y);
    }
    return falseColourPicture(mesh, values, {.title = "illuminance", .unit = "lx"}, camera,
                              options);
  };
  const auto at = [](const Image& image, int x, int y) {
    return std::vector(&image.rgba[std::size_t(y * image.width + x) * 4],
                       &image.rgba[std::size_t(y * image.width + x) * 4] + 3);
  };
  const Image flat = draw(10, 90, 0);
  EXPECT_GT(flat.height, 200);  // the legend is below
  for (const int y : {3, 77, 150}) {
    EXPECT_EQ(at(flat, 99, y), at(flat, 20, y));
    EXPECT_EQ(at(flat, 100, y), at(flat, 180, y));
  }
  // A slope has lines across, white over the dark end; that of 20 lx, 40 pixels down, is broken by
  // its number.
  const Image sloping = draw(10, 10, 0.25);
  int white = 0;
  for (int x = 0; x < 200; ++x) white += at(sloping, x, 40)[0] > 0.95F ? 1 : 0;
  EXPECT_GT(white, 150);
  EXPECT_LT(white, 195);
}

}  // namespace
}  // namespace radiosity
