// Pictures out and in: exact floats in EXR, the sRGB curve in PNG.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "radiosity/results.h"
#include "results/rgbe.h"
#include "support/results_folder.h"

namespace radiosity {
namespace {

class ImageFile : public FolderTest {
 protected:
  /// A byte as OpenImageIO makes a float of it: times 1/255, two roundings.
  static void expectAlike(const std::vector<float>& read, const std::vector<float>& expected) {
    ASSERT_EQ(read.size(), expected.size());
    for (std::size_t k = 0; k < read.size(); ++k) EXPECT_NEAR(read[k], expected[k], 2 * 6e-8f) << k;
  }
  static Image image(int width, int height, std::vector<float> rgba) {
    return {width, height, std::move(rgba)};
  }
};

std::unique_ptr<OIIO::ImageInput> openAsIs(const std::string& path) {
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return OIIO::ImageInput::open(path, &hints);
}

TEST_F(ImageFile, ExrKeepsFloats) {
  // Values no half or 8-bit file could hold; the last pixel was missed by the picture.
  const Image written = image(2, 2,
                              {0.1f, 1e-30f, 12345.678f, 1, 0, 1e30f, -0.5f, 1,  //
                               1.f / 3, 2.f / 3, 16777217.f, 1, 0, 0, 0, 0});
  writeImage(path("x.exr"), written, false,
             std::vector<std::pair<std::string, std::string>>{{"exposure", "1.5 EV"}});
  const Image read = readImage(path("x.exr"));
  EXPECT_EQ(read.width, 2);
  EXPECT_EQ(read.height, 2);
  EXPECT_EQ(read.rgba, written.rgba);
  const auto file = openAsIs(path("x.exr"));
  EXPECT_EQ(file->spec().format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(file->spec().channelnames, (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(file->spec().get_string_attribute("exposure"), "1.5 EV");
}

TEST_F(ImageFile, ExrIsMultipliedByAlpha) {
  const Image written = image(1, 1, {8, 4, 2, 0.25f});
  writeImage(path("x.exr"), written, false);
  std::vector<float> stored(4);
  openAsIs(path("x.exr"))->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, stored.data());
  EXPECT_EQ(stored, (std::vector<float>{2, 1, 0.5f, 0.25f}));
  EXPECT_EQ(readImage(path("x.exr")).rgba, written.rgba);
}

TEST_F(ImageFile, HdrHasASharedExponent) {
  // Ward's format: mantissas of 256 2^-e, cut off, where the largest is m 2^e with m in [.5, 1).
  using Bytes = std::array<std::uint8_t, 4>;
  EXPECT_EQ(rgbeOf({1, 0.5f, 0}), (Bytes{128, 64, 0, 129}));
  EXPECT_EQ(rgbeOf({0.999f, 0.25f, 0.1f}), (Bytes{255, 64, 25, 128}));
  EXPECT_EQ(rgbeOf({1e-33f, 0, 0}), (Bytes{0, 0, 0, 0}));
  // A pixel that misses in part is what reaches it; lines begin with no code of packed ones.
  writeImage(path("x.hdr"), image(2, 1, {8, 4, 2, 0.25f, 3, 3, 3, 0}), false,
             std::vector<std::pair<std::string, std::string>>{{"unit", "W/m^2/sr"}});
  EXPECT_EQ(readImage(path("x.hdr")).rgba, (std::vector<float>{2, 1, 0.5f, 1, 0, 0, 0, 1}));
  expectError<RunError>(path("y.hdr"), "pixel (1, 0) is -1", [&] {
    writeImage(path("y.hdr"), image(2, 1, {1, 1, 1, 1, 0, -1, 0, 1}), false);
  });
}

TEST_F(ImageFile, PngFollowsTheSrgbCurve) {
  // IEC 61966-2-1: 0.5 -> 187.5 (188), 0.2140 -> 0.5 -> 127.5, and the straight part below
  // 0.0031308: 0.002 -> 0.02584 -> 6.6.
  const Image linear = image(4, 2, {0.5f,       0.5f,  0.5f, 1,    0,  1,     2,    1,  //
                                    0.002f,     0.18f, 0.8f, 1,    -1, 1e30f, 0.9f, 1,  //
                                    0.5f,       0.5f,  0.5f, 0.5f, 0,  0,     0,    0,  //
                                    0.0031308f, 0.01f, 0.1f, 1,    1,  1,     1,    1});
  writeImage(path("x.png"), linear, false,
             std::vector<std::pair<std::string, std::string>>{{"exposure", "1.5 EV"}});
  const auto file = openAsIs(path("x.png"));
  EXPECT_EQ(file->spec().format, OIIO::TypeDesc::UINT8);
  EXPECT_EQ(file->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
  EXPECT_EQ(file->spec().get_string_attribute("exposure"), "1.5 EV");
  std::vector<std::uint8_t> stored(32);
  file->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, stored.data());
  EXPECT_EQ(stored, (std::vector<std::uint8_t>{188, 188, 188, 255, 0,   255, 255, 255,  //
                                               7,   118, 231, 255, 0,   255, 243, 255,  //
                                               188, 188, 188, 128, 0,   0,   0,   0,    //
                                               10,  25,  89,  255, 255, 255, 255, 255}));
}

TEST_F(ImageFile, PngStoresDisplayColoursUnchanged) {
  Image shown = image(16, 16, {});
  for (int k = 0; k < 1024; ++k) shown.rgba.push_back(float(k % 256) / 255);
  writeImage(path("x.png"), shown, true);
  expectAlike(readImage(path("x.png")).rgba, shown.rgba);
}

TEST_F(ImageFile, ReadsGreyAndOpaqueFiles) {
  const auto make = [&](const std::string& name, int channels, std::vector<std::uint8_t> bytes) {
    const auto out = OIIO::ImageOutput::create(path(name));
    OIIO::ImageSpec spec(1, 1, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    out->open(path(name), spec);
    out->write_image(OIIO::TypeDesc::UINT8, bytes.data());
    out->close();
    return readImage(path(name)).rgba;
  };
  expectAlike(make("grey.png", 1, {51}), (std::vector<float>{0.2f, 0.2f, 0.2f, 1}));
  expectAlike(make("alpha.png", 2, {51, 102}), (std::vector<float>{0.2f, 0.2f, 0.2f, 0.4f}));
  expectAlike(make("rgb.png", 3, {51, 102, 255}), (std::vector<float>{0.2f, 0.4f, 1, 1}));
  expectAlike(make("rgba.png", 4, {51, 102, 255, 0}), (std::vector<float>{0.2f, 0.4f, 1, 0}));
}

TEST_F(ImageFile, ErrorsNameTheFile) {
  const Image good = image(1, 1, {0, 0, 0, 1});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expectError<InputError>(path("x.tga"), ".png, .exr or .hdr",
                          [&] { writeImage(path("x.tga"), good, false); });
  expectError<InputError>(path("x"), ".png, .exr or .hdr",
                          [&] { writeImage(path("x"), good, false); });
  expectError<InputError>(path("no/x.png"), "does not exist",
                          [&] { writeImage(path("no/x.png"), good, false); });
  expectError<InputError>(path("x.png"), "0 x 0 pixels",
                          [&] { writeImage(path("x.png"), {}, false); });
  expectError<RunError>(path("x.png"), "pixel (1, 0) is not a number", [&] {
    writeImage(path("x.png"), image(2, 1, {0, 0, 0, 1, 0, nan, 0, 1}), false);
  });
  expectError<InputError>(path("x.png"), "no such file", [&] { readImage(path("x.png")); });
  save(path("x.png"), {'n', 'o'});
  expectError<InputError>(path("x.png"), "cannot be read", [&] { readImage(path("x.png")); });
}

TEST_F(ImageFile, TruncatedPicturesAreRefused) {
  Image noise = image(64, 64, {});
  for (int k = 0; k < 64 * 64 * 4; ++k) noise.rgba.push_back(float((k * 7919) % 256) / 255);
  for (const char* name : {"x.png", "x.exr"}) {
    writeImage(path(name), noise, true);
    const std::vector<char> whole = load(path(name));
    for (int part = 0; part < 8; ++part) {
      save(path(name), {whole.begin(), whole.begin() + std::ptrdiff_t(whole.size()) * part / 8});
      expectError<InputError>(path(name), "", [&] { readImage(path(name)); });
    }
  }
}

TEST_F(ImageFile, IsWrittenWholeOrNotAtAll) {
  Image noise = image(256, 256, {});
  for (std::size_t k = 0; k < 256 * 256 * 4; ++k) {
    noise.rgba.push_back(float((k * k * 7919) % 65521) / 65521);
  }
  for (const char* name : {"x.png", "x.exr"}) {
    for (const rlim_t limit : {0, 10, 100, 5000, 60000}) {
      const FullDisk disk(limit);
      expectError<RunError>(path(name), "cannot be written",
                            [&] { writeImage(path(name), noise, false); });
      EXPECT_EQ(files(), 0u) << name << ' ' << limit;
    }
  }
}

}  // namespace
}  // namespace radiosity
