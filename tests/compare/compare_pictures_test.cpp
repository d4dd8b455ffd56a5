// Comparison of pictures, pixel by pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "radiosity/compare.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

using test::errorOf;

ImageFile picture(int width, int height, float r, float g, float b) {
  ImageFile file;
  file.image = {width, height, {}};
  for (int k = 0; k < width * height; ++k) {
    file.image.rgba.insert(file.image.rgba.end(), {r, g, b, 1.0F});
  }
  return file;
}

TEST(ComparePictures, FiguresEqualThoseMadeByHand) {
  const ImageFile a = picture(4, 2, 1, 2, 3);
  ImageFile b = a;
  b.image.rgba[4 * 6 + 1] = 2.5F;  // pixel (2, 1), green
  const Comparison c = compare(a, LightUnit::radiance, b, LightUnit::radiance, {});
  EXPECT_NEAR(c.relativeL2(), std::sqrt(0.25 / (8 * 14)), 1e-12);
  EXPECT_NEAR(c.relativeL2(1), std::sqrt(0.25 / (8 * 4)), 1e-12);
  EXPECT_EQ(c.relativeL2(0), 0);
  EXPECT_EQ(c.largest.place, Vec3(2, 1, 0));
  EXPECT_EQ(c.largest.band, 1);
  EXPECT_EQ(c.cells, 8u);
  EXPECT_NEAR(c.difference[6], 0.7152 * 0.5, 1e-12);
}

TEST(ComparePictures, PixelsMissedByEitherPictureAreLeftOut) {
  const ImageFile a = picture(4, 2, 1, 1, 1);
  ImageFile b = picture(4, 2, 1, 1, 1);
  for (std::size_t k = 0; k < 4; ++k) b.image.rgba[k] = 0;  // pixel 0: nothing hit
  const Comparison c = compare(a, LightUnit::radiance, b, LightUnit::radiance, {});
  EXPECT_EQ(c.relativeL2(), 0);
  EXPECT_EQ(c.area_a, 8);
  EXPECT_EQ(c.area_b, 7);
  EXPECT_EQ(c.cells, 7u);
  EXPECT_TRUE(std::isnan(c.difference[0]));
}

TEST(ComparePictures, RadiosityIsPiTimesRadiance) {
  const ImageFile a = picture(2, 2, 1, 1, 1);
  const auto factor = float(std::numbers::pi);
  const ImageFile b = picture(2, 2, factor, factor, factor);
  EXPECT_LT(compare(a, LightUnit::radiance, b, LightUnit::radiosity, {}).relativeL2(), 1e-7);
  const Comparison wrong = compare(a, LightUnit::radiance, b, LightUnit::radiance, {});
  ASSERT_EQ(wrong.notes.size(), 1u);
  EXPECT_NE(wrong.notes[0].text.find("1 / pi"), std::string::npos);
}

TEST(ComparePictures, ToneMappedPicturesAgainstLightAreRefusedWithTheCure) {
  const ImageFile light = picture(2, 2, 0.5F, 0.5F, 0.5F);
  ImageFile screen = picture(2, 2, 0.5F, 0.5F, 0.5F);
  screen.bytes = true;
  const std::string error =
      errorOf([&] { compare(screen, LightUnit::srgb8, light, LightUnit::radiance, {}); });
  EXPECT_NE(error.find("tone-mapped"), std::string::npos) << error;
  EXPECT_NE(error.find(".exr"), std::string::npos) << error;
  CompareOptions options;
  options.fit_scale = true;
  const Comparison c = compare(screen, LightUnit::srgb8, light, LightUnit::radiance, options);
  // The sRGB curve gives 0.5 the light 0.214041 (IEC 61966-2-1).
  EXPECT_NEAR(c.scale, 0.214041 / 0.5, 1e-5);
  // Two coded pictures need no factor; clipped values are left out.
  ImageFile bright = screen;
  bright.image.rgba[0] = 1;
  const Comparison two = compare(screen, LightUnit::srgb8, bright, LightUnit::srgb8, {});
  EXPECT_EQ(two.relativeL2(), 0);
  EXPECT_EQ(two.clipped, 1);
}

TEST(ComparePictures, PicturesOfOtherSizesOrWithoutCommonPixelsAreRefused) {
  const ImageFile a = picture(4, 2, 1, 1, 1);
  const std::string sizes = errorOf(
      [&] { compare(a, LightUnit::radiance, picture(2, 4, 1, 1, 1), LightUnit::radiance, {}); });
  EXPECT_NE(sizes.find("4 x 2 pixels, B 2 x 4"), std::string::npos) << sizes;
  ImageFile none = a;
  for (std::size_t k = 3; k < none.image.rgba.size(); k += 4) none.image.rgba[k] = 0;
  EXPECT_NE(errorOf([&] { compare(a, LightUnit::radiance, none, LightUnit::radiance, {}); }), "");
}

TEST(ComparePictures, FalseColourPixelsHaveTheLegendBelow) {
  std::vector<double> values(128 * 64, 0.0);
  values[5] = 1;
  values[6] = NAN;
  const Image image = falseColourPixels(128, 64, values, {"difference", "W/m^2/sr"});
  EXPECT_EQ(image.width, 128);
  EXPECT_GT(image.height, 64);
  EXPECT_EQ(image.rgba.size(), std::size_t(4 * image.width * image.height));
  const auto colour = [&](std::size_t k) {
    return std::vector<float>(image.rgba.begin() + std::ptrdiff_t(4 * k),
                              image.rgba.begin() + std::ptrdiff_t(4 * k + 3));
  };
  EXPECT_NE(colour(5), colour(0));
  EXPECT_NE(colour(6), colour(0));
  EXPECT_EQ(colour(7), colour(0));
  EXPECT_THROW(falseColourPixels(3, 3, values, {"", ""}), InputError);
}

}  // namespace
}  // namespace radiosity
