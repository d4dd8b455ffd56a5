#include "results/rgbe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/printable.h"
#include "results/checked_file.h"

namespace radiosity {

std::array<std::uint8_t, 4> rgbeOf(const std::array<float, 3>& colour) {
  constexpr float kBlack = 1e-32f;
  const float largest = std::max({colour[0], colour[1], colour[2]});
  if (!(largest > kBlack)) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(largest, &exponent);  // largest = m 2^exponent, m in [.5, 1)
  std::array<std::uint8_t, 4> stored{};
  for (std::size_t c = 0; c < 3; ++c) {
    stored[c] = std::uint8_t(std::ldexp(colour[c], 8 - exponent));
  }
  stored[3] = std::uint8_t(exponent + 128);
  return stored;
}

namespace {

/// The largest colour that an exponent of eight bits reaches.
constexpr float kBrightest = 1.7e38f;

/// Row by row from the top, not run-length encoded, which readers know from the first bytes.
std::vector<std::uint8_t> pixelsOf(const std::string& path, const Image& image) {
  std::vector<std::uint8_t> pixels;
  pixels.reserve(image.rgba.size());
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
    std::array<float, 3> colour{};
    for (std::size_t c = 0; c < 3; ++c) {
      colour[c] = image.rgba[k + c] * image.rgba[k + 3];
      if (colour[c] >= 0 && colour[c] <= kBrightest) continue;
      throw RunError(
          fmt::format("{}: pixel ({}, {}) is {}, and .hdr holds 0 to {:.2g}; name a file .exr",
                      path, k / 4 % std::size_t(image.width), k / 4 / std::size_t(image.width),
                      colour[c], kBrightest));
    }
    const std::array<std::uint8_t, 4> stored = rgbeOf(colour);
    pixels.insert(pixels.end(), stored.begin(), stored.end());
  }
  return pixels;
}

}  // namespace

void writeRgbe(const std::string& path, const Image& image,
               std::span<const std::pair<std::string, std::string>> metadata) {
  const std::vector<std::uint8_t> pixels = pixelsOf(path, image);
  std::string header = "#?RADIANCE\n";
  for (const auto& [name, value] : metadata) {
    header += fmt::format("{}= {}\n", printable(name), printable(value));
  }
  // Rec. 709, ITU-R BT.709: red, green, blue, white.
  header += "PRIMARIES= .64 .33 .30 .60 .15 .06 .3127 .3290\nFORMAT=32-bit_rle_rgbe\n";
  header += fmt::format("\n-Y {} +X {}\n", image.height, image.width);
  CheckedFile file(path);
  file.write(header);
  file.write(pixels.data(), pixels.size());
  file.commit();
}

}  // namespace radiosity
