#include "scene/texture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

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
    result.problem = "cannot be decoded (" + onOneLine(input.geterror()) + ")";
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
      texture.texels[p * 3 + band] = encoded ? float(linearFromSrgb(sample)) : sample;
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

TextureResult readTexture(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {{}, false, "is not there"};
  const OIIO::ImageSpec hints = readingHints();
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &hints);
  if (!input) return {{}, false, "cannot be read (" + onOneLine(OIIO::geterror()) + ")"};
  return readOpened(*input, path);
}

TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes) {
  const std::string format = formatOf(bytes);
  if (format.empty()) return {{}, false, "is of an unknown image format"};
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  OIIO::Filesystem::IOProxy* proxy = &memory;
  OIIO::ImageSpec hints = readingHints();
  hints.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<const void*>(&proxy));
  // By the format's name: given a file's name, OpenImageIO 2.4 looks for that file first.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!input) return {{}, false, "cannot be decoded (" + onOneLine(OIIO::geterror()) + ")"};
  if (!input->open(name, spec, hints)) {
    return {{}, false, "cannot be decoded (" + onOneLine(input->geterror()) + ")"};
  }
  return readOpened(*input, name);
}

}  // namespace radiosity
