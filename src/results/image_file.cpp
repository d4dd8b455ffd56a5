// Writes and reads pictures.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "base/file_name.h"
#include "base/image_codec.h"
#include "base/input_file.h"
#include "base/srgb.h"
#include "radiosity/results.h"
#include "results/checked_file.h"
#include "results/rgbe.h"

namespace radiosity {

namespace {

using Metadata = std::span<const std::pair<std::string, std::string>>;

std::uint8_t toByte(double value) {
  return std::uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

/// Joins the lines of OpenImageIO's reasons; our errors have one line.
std::string reason(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ';');
  return text;
}

void checkImage(const std::string& path, const Image& image) {
  const std::size_t pixels =
      std::size_t(std::max(image.width, 0)) * std::size_t(std::max(image.height, 0));
  if (pixels == 0 || image.rgba.size() != 4 * pixels) {
    throw InputError(fmt::format("{}: a picture of {} x {} pixels needs {} values, not {}", path,
                                 image.width, image.height, 4 * pixels, image.rgba.size()));
  }
  for (std::size_t k = 0; k < image.rgba.size(); ++k) {
    if (!std::isnan(image.rgba[k])) continue;
    throw RunError(fmt::format("{}: pixel ({}, {}) is not a number", path,
                               k / 4 % std::size_t(image.width), k / 4 / std::size_t(image.width)));
  }
}

/// Colours multiplied by alpha, as OpenEXR requires: a pixel is then the radiance that reaches it.
std::vector<float> associated(const Image& image) {
  std::vector<float> pixels = image.rgba;
  for (std::size_t k = 0; k < pixels.size(); k += 4) {
    for (std::size_t c = 0; c < 3; ++c) pixels[k + c] *= pixels[k + 3];
  }
  return pixels;
}

/// The layers' channels after those of the picture, each pixel's together.
std::vector<float> withLayers(const std::vector<float>& pixels, std::span<const ImageLayer> layers,
                              std::size_t channels) {
  const std::size_t count = pixels.size() / 4;
  std::vector<float> all(count * channels);
  std::size_t first = 0;
  const auto put = [&](const std::vector<float>& values, std::size_t width) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      all[k / width * channels + first + k % width] = values[k];
    }
    first += width;
  };
  put(pixels, 4);
  for (const ImageLayer& layer : layers) put(layer.values, layer.values.size() / count);
  return all;
}

void checkLayers(const std::string& path, const Image& image, std::span<const ImageLayer> layers) {
  for (const ImageLayer& layer : layers) {
    const std::size_t needed =
        image.rgba.size() / 4 * std::max<std::size_t>(1, layer.channels.size());
    if (layer.values.size() != needed) {
      throw InputError(fmt::format("{}: layer {} needs {} values, not {}", path, layer.name, needed,
                                   layer.values.size()));
    }
    if (std::ranges::any_of(layer.values, [](float value) { return std::isnan(value); })) {
      throw RunError(
          fmt::format("{}: layer {} has a value that is not a number", path, layer.name));
    }
  }
}

/// Adds the names of their channels, and their units as attributes.
void describeLayers(std::span<const ImageLayer> layers, std::vector<std::string>& channels,
                    std::vector<std::pair<std::string, std::string>>& attributes) {
  for (const ImageLayer& layer : layers) {
    if (layer.channels.empty()) channels.push_back(layer.name);
    for (const std::string& channel : layer.channels)
      channels.push_back(layer.name + "." + channel);
    if (!layer.unit.empty()) attributes.emplace_back(layer.name + ".unit", layer.unit);
  }
}

/// Colours for PNG, not multiplied by alpha; alpha is linear in both formats.
std::vector<std::uint8_t> encoded(const Image& image, bool display_referred) {
  std::vector<std::uint8_t> pixels(image.rgba.size());
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const double value = std::clamp(double(image.rgba[k]), 0.0, 1.0);
    pixels[k] = toByte(k % 4 == 3 || display_referred ? value : srgbFromLinear(value));
  }
  return pixels;
}

/// Encodes in memory and writes the bytes ourselves: OpenImageIO's PNG writer does not notice a
/// full disk.
void save(const std::string& path, const ImageToEncode& image) {
  CheckedFile file(path);
  const EncodedImage written = imageCodec().encode(path, image);
  if (!written.problem.empty()) {
    throw RunError(fmt::format("{}: cannot be encoded: {}", path, reason(written.problem)));
  }
  file.write(written.bytes.data(), written.bytes.size());
  file.commit();
}

DecodedImage readSamples(const std::string& path, double max_image) {
  try {
    return imageCodec().read(path, {max_image * 1e6});
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("{}: the picture does not fit into memory; make it smaller", path));
  }
}

}  // namespace

void writeImage(const std::string& path, const Image& image, bool display_referred,
                Metadata metadata, std::span<const ImageLayer> layers) {
  checkImage(path, image);
  checkLayers(path, image, layers);
  const std::string extension = lowerExtension(path);
  std::vector<std::pair<std::string, std::string>> attributes(metadata.begin(), metadata.end());
  ImageToEncode file;
  file.width = image.width;
  file.height = image.height;
  describeLayers(layers, file.channels, attributes);
  file.metadata = attributes;
  if (extension == ".exr") {
    const std::vector<float> pixels = withLayers(associated(image), layers, file.channels.size());
    file.floating = true;
    file.multiplied = true;
    file.colour_space = display_referred ? "sRGB" : "Linear";
    file.pixels = pixels.data();
    save(path, file);
  } else if (!layers.empty() && (extension == ".png" || extension == ".hdr")) {
    throw InputError(path + ": layers are values of .exr; name a file .exr");
  } else if (extension == ".hdr") {
    if (display_referred) throw InputError(path + ": .hdr is for light; name a file .png");
    writeRgbe(path, image, metadata);
  } else if (extension == ".png") {
    const std::vector<std::uint8_t> pixels = encoded(image, display_referred);
    file.colour_space = "sRGB";
    file.pixels = pixels.data();
    save(path, file);
  } else {
    throw InputError(fmt::format("{}: '{}' is no picture format; name a file .png, .exr or .hdr",
                                 path, extension));
  }
}

ImageFile readImageFile(const std::string& path, double max_image) {
  requireFile(path);
  const DecodedImage decoded = readSamples(path, max_image);
  if (!decoded.too_large.empty()) {
    throw InputError(fmt::format("{}: {}", path, decoded.too_large));
  }
  if (!decoded.opened) {
    throw InputError(
        fmt::format("{}: cannot be read as a picture: {}", path, reason(decoded.problem)));
  }
  if (!decoded.problem.empty()) {
    throw InputError(fmt::format("{}: the picture is damaged: {}", path, reason(decoded.problem)));
  }
  const auto channels = std::size_t(decoded.channels);
  const std::size_t count = std::size_t(decoded.width) * std::size_t(decoded.height);
  const bool grey = channels < 3;
  const bool has_alpha = channels == 2 || channels >= 4;
  // EXR and other formats multiply colours by alpha; we divide by it again.
  const bool multiplied = has_alpha && decoded.multiplied;
  ImageFile file;
  file.bytes = !decoded.floating;
  file.quantity = decoded.quantity;
  Image& image = file.image;
  image = {decoded.width, decoded.height, std::vector<float>(count * 4)};
  for (std::size_t k = 0; k < count; ++k) {
    const float* in = &decoded.samples[k * channels];
    float* out = &image.rgba[k * 4];
    const float alpha = has_alpha ? in[grey ? 1 : 3] : 1.f;
    for (std::size_t c = 0; c < 3; ++c) {
      out[c] = in[grey ? 0 : c];
      if (multiplied && alpha != 0) out[c] /= alpha;
    }
    out[3] = alpha;
  }
  return file;
}

Image readImage(const std::string& path) { return readImageFile(path).image; }

}  // namespace radiosity
