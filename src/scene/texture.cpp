#include "scene/texture.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "base/image_codec.h"
#include "base/srgb.h"
#include "scene/text.h"

namespace radiosity {

namespace {

bool startsWith(std::span<const unsigned char> bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), bytes.begin(),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

/// The name of the format, as OpenImageIO calls it; empty where it is not one we know.
std::string formatOf(std::span<const unsigned char> bytes) {
  if (startsWith(bytes, "\x89PNG")) return "png";
  if (startsWith(bytes, "\xff\xd8\xff")) return "jpeg";
  if (startsWith(bytes, "RIFF")) return "webp";
  if (startsWith(bytes, "BM")) return "bmp";
  return {};
}

TextureResult textureFrom(const DecodedImage& image, const std::string& name) {
  TextureResult result;
  if (image.width < 1 || image.height < 1 || image.channels < 1) {
    result.problem = "holds no pixels";
    return result;
  }
  if (!image.problem.empty()) {
    result.problem = "cannot be decoded (" + onOneLine(image.problem) + ")";
    return result;
  }
  const auto channels = std::size_t(image.channels);
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  Texture& texture = result.texture;
  texture.name = name;
  texture.width = image.width;
  texture.height = image.height;
  texture.texels.resize(pixels * 3);
  result.has_alpha = channels == 2 || channels == 4;
  // Samples that are meant to be looked at carry the sRGB curve.
  const bool encoded = !image.floating && !image.linear;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t band = 0; band < 3; ++band) {
      const float sample = image.samples[p * channels + (channels >= 3 ? band : 0)];
      texture.texels[p * 3 + band] = encoded ? float(linearFromSrgb(sample)) : sample;
    }
  }
  const bool usable = std::all_of(texture.texels.begin(), texture.texels.end(),
                                  [](float t) { return t >= 0.0f && t <= 1.0f; });
  if (!usable) result.problem = "has texels outside 0 to 1, which are no reflectances";
  return result;
}

}  // namespace

TextureResult readTexture(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {{}, false, "is not there"};
  const DecodedImage image = imageCodec().read(path);
  if (!image.opened) return {{}, false, "cannot be read (" + onOneLine(image.problem) + ")"};
  return textureFrom(image, path);
}

TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes) {
  const std::string format = formatOf(bytes);
  if (format.empty()) return {{}, false, "is of an unknown image format"};
  const DecodedImage image = imageCodec().decode(name, format, bytes);
  if (!image.opened) return {{}, false, "cannot be decoded (" + onOneLine(image.problem) + ")"};
  return textureFrom(image, name);
}

}  // namespace radiosity
