#include "scene/texture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace radiosity {

namespace {

bool startsWith(std::span<const unsigned char> bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), bytes.begin(),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

/// A file name whose extension tells OpenImageIO the format; empty where it is not one we know.
std::string nameForFormat(std::span<const unsigned char> bytes) {
  if (startsWith(bytes, "\x89PNG")) return "embedded.png";
  if (startsWith(bytes, "\xff\xd8\xff")) return "embedded.jpg";
  if (startsWith(bytes, "RIFF")) return "embedded.webp";
  if (startsWith(bytes, "BM")) return "embedded.bmp";
  return {};
}

/// Samples that are meant to be looked at carry the sRGB curve.
bool isEncoded(const OIIO::ImageSpec& spec) {
  if (spec.format.is_floating_point()) return false;
  return !OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
}

TextureResult readOpened(OIIO::ImageInput& input, const std::string& name) {
  TextureResult result;
  const OIIO::ImageSpec spec = input.spec();
  const auto channels = std::size_t(spec.nchannels);
  if (spec.width < 1 || spec.height < 1 || channels < 1) {
    result.problem = "holds no pixels";
    return result;
  }
  const std::size_t pixels = std::size_t(spec.width) * std::size_t(spec.height);
  std::vector<float> samples(pixels * channels);
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, samples.data())) {
    result.problem = "cannot be decoded (" + input.geterror() + ")";
    return result;
  }
  Texture& texture = result.texture;
  texture.name = name;
  texture.width = spec.width;
  texture.height = spec.height;
  texture.texels.resize(pixels * 3);
  result.has_alpha = channels == 2 || channels == 4;
  const bool encoded = isEncoded(spec);
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t band = 0; band < 3; ++band) {
      const float sample = samples[p * channels + (channels >= 3 ? band : 0)];
      texture.texels[p * 3 + band] = encoded ? float(srgbToLinear(sample)) : sample;
    }
  }
  const bool usable = std::all_of(texture.texels.begin(), texture.texels.end(),
                                  [](float t) { return t >= 0.0f && t <= 1.0f; });
  if (!usable) result.problem = "has texels outside 0 to 1, which are no reflectances";
  return result;
}

OIIO::ImageSpec readingHints() {
  // Colours as they are stored: not multiplied by an alpha that has no meaning here.
  OIIO::ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  return hints;
}

}  // namespace

double srgbToLinear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

TextureResult readTexture(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {{}, false, "is not there"};
  const OIIO::ImageSpec hints = readingHints();
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &hints);
  if (!input) return {{}, false, "cannot be read (" + OIIO::geterror() + ")"};
  return readOpened(*input, path);
}

TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes) {
  const std::string format_name = nameForFormat(bytes);
  if (format_name.empty()) return {{}, false, "is of an unknown image format"};
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const OIIO::ImageSpec hints = readingHints();
  const std::unique_ptr<OIIO::ImageInput> input =
      OIIO::ImageInput::open(format_name, &hints, &memory);
  if (!input) return {{}, false, "cannot be decoded (" + OIIO::geterror() + ")"};
  return readOpened(*input, name);
}

}  // namespace radiosity
