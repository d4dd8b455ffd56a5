// False colour: the map, pixels without a value, and a true and legible legend.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "base/srgb.h"
#include "radiosity/render.h"
#include "render/bitmap_text.h"
#include "render/colour_map.h"
#include "render/legend.h"
#include "support/quad_mesh.h"

namespace radiosity {
namespace {

using test::QuadMesh;

std::array<int, 3> coded(const Vec3& linear) {
  std::array<int, 3> c{};
  for (int b = 0; b < 3; ++b) c[b] = int(std::lround(255 * srgbFromLinear(linear[b])));
  return c;
}

TEST(ColourMap, IsViridis) {
  // Entries 0, 127 and 255 of the 256 published ones, to 8 bits. Between the control points (every
  // 16th) the chord stays within 2 of the curve.
  const ColourMap map;
  const auto near = [&](int entry, std::array<int, 3> published) {
    const std::array<int, 3> c = coded(map.at(entry / 255.0));
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(c[b], published[b], 2) << entry;
  };
  near(0, {68, 1, 84});
  near(127, {33, 144, 140});
  near(255, {253, 231, 37});
  EXPECT_EQ(map.at(-1), map.at(0));
  EXPECT_EQ(map.at(2), map.at(1));
}

TEST(ColourMap, LightnessRisesSteadily) {
  // CIE 1976 lightness of the colours; a perceptually uniform map rises by equal amounts.
  const ColourMap map;
  const auto lightness = [&](double t) {
    const Vec3 c = map.at(t);
    return 116 * std::cbrt(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z) - 16;
  };
  const double mean = (lightness(1) - lightness(0)) / 100;
  EXPECT_GT(mean, 0.7);  // from about 15 to about 90
  for (int k = 0; k < 100; ++k) {
    const double step = lightness((k + 1) / 100.0) - lightness(k / 100.0);
    // Eight-bit control points move a step by up to 0.2.
    EXPECT_NEAR(step, mean, 0.3) << k;
  }
}

TEST(BitmapText, EveryPrintableCharacterIsItsOwnGlyph) {
  std::set<std::vector<float>> seen;
  for (char c = ' '; c <= '~'; ++c) {
    Image image{kGlyphWidth, kGlyphHeight, std::vector<float>(kGlyphWidth * kGlyphHeight * 4)};
    drawText(image, 0, 0, 1, std::string(1, c), 1);
    EXPECT_TRUE(seen.insert(image.rgba).second) << c;
  }
  EXPECT_EQ(textWidth("abc", 2), 2 * (3 * kGlyphAdvance - 1));
  EXPECT_EQ(textWidth("W/m\xc2\xb2", 1), textWidth("W/m2", 1));
  EXPECT_EQ(textWidth("", 3), 0);
}

/// Three plates side by side that fill the left three quarters of the picture.
PatchMesh plates() {
  QuadMesh builder;
  for (int k = 0; k < 3; ++k) builder.grid("plate", {k - 2.0, -2, 0}, {1, 0, 0}, {0, 4, 0});
  return builder.build();
}

Image falseColour(const std::vector<double>& values, const FalseColour& legend, int width = 320,
                  int height = 240) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.smooth = false;
  Camera camera;
  camera.eye = {0, 0, 2};
  camera.vertical_fov = 2 * std::atan(1.0 * height / width);  // 4 m wide
  Progress silent;
  return renderFalseColour(plates(), values, legend, camera, options, silent);
}

std::array<int, 3> at(const Image& image, int x, int y) {
  const float* p = image.rgba.data() + (std::size_t(y) * image.width + x) * 4;
  return {int(std::lround(p[0] * 255)), int(std::lround(p[1] * 255)), int(std::lround(p[2] * 255))};
}

std::vector<float> strip(const Image& image) {
  const int rows = Legend({"t", "u"}, image.width, image.height).height();
  EXPECT_GT(rows, 0);
  return {image.rgba.end() - std::ptrdiff_t(rows) * image.width * 4, image.rgba.end()};
}

TEST(FalseColour, ValuesHaveTheirColourAndMissesAreGrey) {
  const Image image = falseColour({0.0, 0.5, 1.0}, {"t", "u", 0, 1});
  const ColourMap map;
  EXPECT_EQ(at(image, 70, 60), coded(map.at(0.0)));
  EXPECT_EQ(at(image, 130, 60), coded(map.at(0.5)));
  EXPECT_EQ(at(image, 180, 60), coded(map.at(1.0)));
  const auto miss = at(image, 300, 60);
  EXPECT_EQ(miss[0], miss[1]);
  EXPECT_EQ(miss[1], miss[2]);
  for (std::size_t k = 3; k < image.rgba.size(); k += 4) ASSERT_EQ(image.rgba[k], 1.0f);
}

TEST(FalseColour, TheDefaultRangeIsThatOfVisibleValues) {
  const Image by_itself = falseColour({2.0, 3.5, 7.0}, {"t", "u"});
  const Image told = falseColour({2.0, 3.5, 7.0}, {"t", "u", 2, 7});
  EXPECT_EQ(by_itself.rgba, told.rgba);
  // A value out of sight does not count: the camera sees x > -2 only.
  QuadMesh builder;
  builder.grid("plate", {-1, -2, 0}, {2, 0, 0}, {0, 4, 0}, 2, 1);
  builder.grid("plate", {50, -2, 0}, {2, 0, 0}, {0, 4, 0});
  const PatchMesh mesh = builder.build();
  Camera camera;
  camera.eye = {0, 0, 2};
  RenderOptions options;
  options.smooth = false;
  Progress silent;
  const auto draw = [&](double hidden) {
    return renderFalseColour(mesh, std::vector<double>{1, 2, hidden}, {"t", "u"}, camera, options,
                             silent);
  };
  EXPECT_EQ(draw(1.5).rgba, draw(1000).rgba);
}

TEST(FalseColour, ALampInViewLeavesTheRestItsColours) {
  QuadMesh builder;  // a wall from 0 to 1, before it a lamp that covers 0.25% of the picture
  builder.grid("wall", {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 100, 1);
  builder.grid("lamp", {0, 0, 0.1}, {0.1, 0, 0}, {0, 0.1, 0});
  const PatchMesh mesh = builder.build();
  std::vector<double> values(101, 500.0);
  for (int k = 0; k < 100; ++k) values[k] = (k + 0.5) / 100;
  Camera camera;
  camera.eye = {0, 0, 2};
  camera.vertical_fov = std::numbers::pi / 2;
  RenderOptions options;
  options.smooth = false;
  Progress silent;
  const auto draw = [&](double low, double high) {
    return renderFalseColour(mesh, values, {"t", "u", low, high}, camera, options, silent).rgba;
  };
  // 99% of the pixels lie below the column of value 0.985 or 0.995.
  const auto shown = draw(0, 0);
  EXPECT_TRUE(shown == draw(0.005, 0.985) || shown == draw(0.005, 0.995));
}

TEST(FalseColour, TheLegendTellsRangesApart) {
  const std::vector<double> values = {0.2, 0.5, 0.8};
  const auto with = [&](double low, double high) {
    return strip(falseColour(values, {"t", "u", low, high}));
  };
  EXPECT_EQ(with(0, 1), with(0, 1));
  EXPECT_NE(with(0, 1), with(0, 2));
  EXPECT_NE(with(0, 1), with(0.1, 1));
  // Row sums stand on 1: the digits that differ must be shown.
  EXPECT_NE(with(0.99998, 1.00001), with(0.99997, 1.00001));
  EXPECT_NE(with(0.99998, 1.00001), with(0.99998, 1.00002));
  // Values beyond an end change its label.
  const auto clipped = strip(falseColour({0.2, 0.5, 5}, {"t", "u", 0, 1}));
  EXPECT_NE(with(0, 1), clipped);
  EXPECT_NE(strip(falseColour(values, {"t", "u", 0, 1})),
            strip(falseColour(values, {"title", "u", 0, 1})));
  EXPECT_NE(strip(falseColour(values, {"t", "u", 0, 1})),
            strip(falseColour(values, {"t", "v", 0, 1})));
}

TEST(FalseColour, TheBarRunsFromLowToHighAndTheTextStaysInside) {
  const ColourMap map;
  for (const int width : {200, 512, 1024}) {
    const Image image = falseColour({0.123456, -5.25e-7, 1.0}, {"form factor", ""}, width, width);
    const int rows = Legend({"form factor", ""}, width, width).height();
    std::set<std::array<int, 3>> colours;
    int ink = 0;
    for (int y = width - rows; y < width; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto c = at(image, x, y);
        colours.insert(c);
        if (c[0] < 230 || c[0] != c[1] || c[0] != c[2]) continue;
        ++ink;
        EXPECT_TRUE(x > 1 && x < width - 2 && y > width - rows + 1 && y < width - 2);
      }
    }
    EXPECT_GT(ink, 200) << width;
    EXPECT_TRUE(colours.contains(coded(map.at(0))));
    EXPECT_TRUE(colours.contains(coded(map.at(1))));
    EXPECT_GT(colours.size(), 100u);
    // A capital is at least 7 pixels high and 1/80 of the picture: legible at its size.
    EXPECT_GE(rows, width / 10);
    EXPECT_LE(rows, width / 4);
  }
}

/// The middles of the numbers in the lowest line of text, in columns.
std::vector<double> numbersIn(const Image& image, int scale) {
  std::vector<double> middles;
  int first = -1;
  int last = -1;
  const int between = 3 * scale;  // within a number there are one or two columns of the font
  for (int x = 0; x <= image.width; ++x) {
    bool ink = false;
    for (int y = image.height - (kGlyphHeight + 4) * scale; x < image.width && y < image.height;
         ++y) {
      ink = ink || at(image, x, y)[0] > 230;
    }
    if (ink && first < 0) first = x;
    if (first >= 0 && (x - last > between || x == image.width) && !ink) {
      middles.push_back((first + last) / 2.0);
      first = -1;
    }
    if (ink) last = x;
  }
  return middles;
}

TEST(FalseColour, NoNumberIsMissingInTheRow) {
  // The last step before the end is as long as the others, wherever there is no room for steps of
  // 500 beside ">=3000".
  for (const double high : {3000.0, 500.0, 10000.0, 4.0}) {
    const Image image = falseColour({0, 0.5 * high, 2 * high}, {"t", "u", 0, high}, 512, 400);
    const int scale = Legend({"t", "u"}, 512, 400).scale();
    const std::vector<double> middles = numbersIn(image, scale);
    ASSERT_GE(middles.size(), 3u) << high;
    const double step = middles[1] - 4.0 * scale;
    const double end = 512 - 4.0 * scale;                                       // of the bar
    EXPECT_NEAR(end - middles[middles.size() - 2], step, 2.0 * scale) << high;  // a glyph is uneven
  }
}

TEST(FalseColour, OddRangesAreDrawn) {
  for (const auto& [low, high] : std::vector<std::pair<double, double>>{
           {1, 1}, {-1e300, 1e300}, {0, 5e-324}, {1e15, 1e15 + 1}, {-2, -1}, {1e6, 1e6 + 1e-9}}) {
    EXPECT_NO_THROW(falseColour({low, high, low}, {"t", "u"})) << low << " " << high;
  }
  const Image constant = falseColour({3, 3, 3}, {"t", "u"});
  EXPECT_EQ(at(constant, 100, 60), coded(ColourMap().at(0.5)));
}

TEST(FalseColour, ATinyPictureHasNoLegend) {
  const Image image = falseColour({0, 0.5, 1}, {"t", "u"}, 40, 30);
  EXPECT_EQ(at(image, 39, 29), at(image, 39, 0));
  EXPECT_EQ(at(image, 15, 29), at(image, 15, 1));
}

TEST(FalseColour, WrongLengthIsRefused) {
  EXPECT_THROW(falseColour({0, 1}, {"t", "u"}), InputError);
}

}  // namespace
}  // namespace radiosity
