// FLIP and SSIM, where both can be worked out by hand; pictures of other sizes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "compare/flip.h"
#include "compare/similarity.h"
#include "radiosity/compare.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

constexpr int kSide = 32;

ColourPlane uniform(const Vec3& colour) {
  return {kSide, kSide, std::vector<Vec3>(std::size_t(kSide) * kSide, colour)};
}

/// A picture with structure at all sizes: a ramp, a checkerboard and a bright pixel.
ColourPlane busy() {
  ColourPlane plane = uniform(Vec3(0));
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      plane.pixels[std::size_t(y) * kSide + std::size_t(x)] =
          Vec3(x / 40.0, (x / 3 + y / 3) % 2 == 0 ? 0.2 : 0.6, y / 40.0);
    }
  }
  plane.pixels[500] = Vec3(0.9);
  return plane;
}

Plane greyPlane(double even, double odd) {
  Plane plane{kSide, kSide, {}};
  for (int k = 0; k < kSide * kSide; ++k)
    plane.values.push_back((k % kSide + k / kSide) % 2 == 0 ? even : odd);
  return plane;
}

/// L* of a grey.
double lightness(double grey) {
  return grey > 216.0 / 24389 ? 116 * std::cbrt(grey) - 16 : 24389.0 / 27 * grey;
}

/// FLIP of two greys without structure: the difference in lightness to the power of .7, over .4 of
/// that of green and blue times .95, and above that the rest to 1. The two have L* = 87.735,
/// a* = -86.183, b* = 83.180 and 32.297, 79.188, -107.860 (B. Lindbloom, "Color calculator", sRGB,
/// D65), a* and b* times L* / 100 (Hunt).
double flipOfGreys(double a, double b) {
  const double largest =
      std::pow((87.735 - 32.297) + std::hypot(-86.183 * .87735 - 79.188 * .32297,
                                              83.180 * .87735 + 107.860 * .32297),
               0.7);
  const double power = std::pow(std::abs(lightness(a) - lightness(b)), 0.7);
  const double knee = 0.4 * largest;
  return power < knee ? 0.95 / knee * power : 0.95 + (power - knee) / (largest - knee) * 0.05;
}

double largest(const Plane& plane) {
  return *std::max_element(plane.values.begin(), plane.values.end());
}

TEST(Flip, TheSameIsZeroToTheBit) {
  EXPECT_EQ(largest(flipOfShown(busy(), busy())), 0);
  EXPECT_EQ(largest(flipOfLight(busy(), busy())), 0);
}

TEST(Flip, GreenAndBlueDifferAllThatColoursCan) {
  for (const double value : flipOfShown(uniform({0, 1, 0}), uniform({0, 0, 1})).values) {
    EXPECT_NEAR(value, 1, 1e-9);  // rounding of the filter's sums
  }
}

TEST(Flip, GreysDifferByTheirLightness) {
  // Lindbloom's figures have five digits.
  EXPECT_NEAR(flipOfShown(uniform(Vec3(0)), uniform(Vec3(1))).at(7, 9), flipOfGreys(0, 1), 1e-4);
  EXPECT_NEAR(flipOfShown(uniform(Vec3(.2)), uniform(Vec3(.3))).at(0, 0), flipOfGreys(.2, .3),
              1e-4);
  EXPECT_NEAR(flipOfShown(uniform(Vec3(2)), uniform(Vec3(1))).at(0, 0), 0, 1e-9);  // both white
}

TEST(Flip, AnEdgeCountsMoreThanItsColours) {
  ColourPlane edge = uniform(Vec3(.3));
  for (int y = 0; y < kSide; ++y)
    for (int x = kSide / 2; x < kSide; ++x)
      edge.pixels[std::size_t(y) * kSide + std::size_t(x)] = Vec3(.4);
  const Plane flip = flipOfShown(edge, uniform(Vec3(.3)));
  // Three degrees off the edge is out of reach of all filters: of 67 pixels a degree the widest has
  // 10, that of features 9.
  EXPECT_NEAR(flip.at(0, 5), 0, 1e-9);
  EXPECT_NEAR(flip.at(kSide - 1, 5), flipOfGreys(.3, .4), 1e-4);
  EXPECT_GT(flip.at(kSide / 2 + 1, 5), flipOfGreys(.3, .4));
}

TEST(Flip, OfLightIsWorstWhereTheCurveShowsMost) {
  // The exposure that takes the reference to .85 takes twice as much to the curve's value there.
  const auto curve = [](double x) { return x * (2.51 * x + .03) / (x * (2.43 * x + .59) + .14); };
  double low = 0;
  double high = 10;
  for (int k = 0; k < 100; ++k) (curve((low + high) / 2) < .85 ? low : high) = (low + high) / 2;
  const double expected = flipOfGreys(.85, std::min(1.0, curve(2 * low)));
  EXPECT_NEAR(flipOfLight(uniform(Vec3(3)), uniform(Vec3(6))).at(4, 4), expected, 1e-4);
}

TEST(Flip, OfLightDoesNotDependOnTheUnit) {
  ColourPlane a = busy();
  ColourPlane b = busy();
  for (Vec3& c : b.pixels) c *= Vec3(1.1, 1, .9);
  const Plane once = flipOfLight(a, b);
  for (Vec3& c : a.pixels) c *= 1024;
  for (Vec3& c : b.pixels) c *= 1024;
  const Plane more = flipOfLight(a, b);
  for (std::size_t k = 0; k < once.values.size(); ++k) {
    EXPECT_NEAR(once.values[k], more.values[k], 1e-9);  // logarithms of other numbers
  }
}

TEST(Similarity, TheSameIsOne) {
  const Plane plane = greyPlane(.2, .7);
  EXPECT_NEAR(structuralSimilarity(plane, plane).value(), 1, 1e-12);
}

TEST(Similarity, OfUniformPicturesIsThatOfTheirMeans) {
  const double c1 = 1e-4;
  const double expected = (2 * .3 * .5 + c1) / (.3 * .3 + .5 * .5 + c1);
  EXPECT_NEAR(structuralSimilarity(greyPlane(.3, .3), greyPlane(.5, .5)).value(), expected, 1e-12);
}

TEST(Similarity, OfAPatternIsThatOfItsContrastAndItsSign) {
  const double c2 = 9e-4;
  // Of a checkerboard the window's mean is off by the Gaussian's share at this frequency, e^-22.
  EXPECT_NEAR(structuralSimilarity(greyPlane(.1, .9), greyPlane(.3, .7)).value(),
              (2 * .4 * .2 + c2) / (.4 * .4 + .2 * .2 + c2), 1e-6);
  EXPECT_NEAR(structuralSimilarity(greyPlane(.1, .9), greyPlane(.9, .1)).value(),
              (-2 * .4 * .4 + c2) / (2 * .4 * .4 + c2), 1e-6);
}

TEST(Similarity, NeedsAWindow) {
  EXPECT_FALSE(
      structuralSimilarity({10, 11, std::vector<double>(110)}, {10, 11, std::vector<double>(110)}));
  EXPECT_TRUE(
      structuralSimilarity({11, 11, std::vector<double>(121)}, {11, 11, std::vector<double>(121)}));
}

ImageFile light(int width, int height) {
  ImageFile file;
  file.image = {width, height, {}};
  for (int k = 0; k < width * height; ++k) {
    const int row = k / width;
    file.image.rgba.insert(file.image.rgba.end(), {float(k % width), 1, float(row), 1});
  }
  return file;
}

TEST(ComparedSizes, BlocksOfTheLargerAreComparedByTheirMeans) {
  ImageFile fine = light(8, 4);
  ImageFile coarse = light(4, 2);
  for (std::size_t k = 0; k < coarse.image.rgba.size(); k += 4) {
    coarse.image.rgba[k] = 2 * coarse.image.rgba[k] + .5F;
    coarse.image.rgba[k + 2] = 2 * coarse.image.rgba[k + 2] + .5F;
  }
  fine.image.rgba[3] = 0;  // shows nothing: the mean of the block is of the three others
  coarse.image.rgba[0] = 2.0F / 3;
  coarse.image.rgba[2] = 2.0F / 3;
  for (const bool swapped : {false, true}) {
    const Comparison c = compare(swapped ? coarse : fine, LightUnit::radiance,
                                 swapped ? fine : coarse, LightUnit::radiance, {});
    EXPECT_LT(c.relativeL2(), 1e-7);  // floats
    EXPECT_EQ(c.cells, 8u);
    ASSERT_EQ(c.notes.size(), 1u);
    EXPECT_NE(c.notes[0].text.find("means of 2 x 2 of its 8 x 4 pixels"), std::string::npos);
  }
  EXPECT_NE(test::errorOf([&] {
              compare(light(8, 4), LightUnit::radiance, light(4, 4), LightUnit::radiance, {});
            }).find("8 x 4"),
            std::string::npos);
}

TEST(Perceived, DifferencesComeWhereAskedFor) {
  CompareOptions options;
  const ImageFile a = light(16, 16);
  EXPECT_FALSE(compare(a, LightUnit::radiance, a, LightUnit::radiance, options).perceived);
  options.perceived = true;
  const Comparison c = compare(a, LightUnit::radiance, a, LightUnit::radiance, options);
  EXPECT_EQ(c.perceived.value().flip, 0);
  EXPECT_NEAR(c.perceived->ssim.value(), 1, 1e-12);
  EXPECT_TRUE(c.perceived->exposure_ev);
  ImageFile dim = a;
  for (float& value : dim.image.rgba) value /= 20;
  const Comparison coded = compare(dim, LightUnit::srgb8, dim, LightUnit::srgb8, options);
  EXPECT_FALSE(coded.perceived.value().exposure_ev);
}

}  // namespace
}  // namespace radiosity
