#include "images/image_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "base/lower_case.h"

namespace radiosity {

namespace {

using Bytes = std::span<const unsigned char>;
using Size = std::pair<std::size_t, std::size_t>;
using namespace std::string_view_literals;

bool hasAt(Bytes bytes, std::size_t at, std::string_view mark) {
  return bytes.size() >= at + mark.size() &&
         std::equal(mark.begin(), mark.end(), bytes.begin() + std::ptrdiff_t(at),
                    [](char a, unsigned char b) { return static_cast<unsigned char>(a) == b; });
}

/// An unsigned number of `count` bytes, the least significant first; 0 beyond the end.
std::uint32_t little(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = count; k-- > 0;) {
    value = value << 8 | (at + k < bytes.size() ? bytes[at + k] : 0u);
  }
  return value;
}

std::uint32_t big(Bytes bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    value = value << 8 | (at + k < bytes.size() ? bytes[at + k] : 0u);
  }
  return value;
}

/// BITMAPCOREHEADER has 16-bit sizes; the others 32-bit ones, a negative height from the top down.
Size bmpSize(Bytes bytes) {
  if (little(bytes, 14, 4) == 12) return {little(bytes, 18, 2), little(bytes, 20, 2)};
  const auto absolute = [&](std::size_t at) {
    return std::size_t(std::abs(std::int64_t(std::int32_t(little(bytes, at, 4)))));
  };
  return {absolute(18), absolute(22)};
}

/// The first chunk: lossy, lossless, or extended with a canvas of its own (RFC 9649, 2).
Size webpSize(Bytes bytes) {
  if (hasAt(bytes, 12, "VP8X")) return {little(bytes, 24, 3) + 1, little(bytes, 27, 3) + 1};
  if (hasAt(bytes, 12, "VP8L")) {
    const std::uint32_t bits = little(bytes, 21, 4);
    return {(bits & 0x3fffu) + 1, (bits >> 14 & 0x3fffu) + 1};
  }
  return {little(bytes, 26, 2) & 0x3fffu, little(bytes, 28, 2) & 0x3fffu};
}

}  // namespace

std::string imageFormatOf(Bytes start, const std::string& name) {
  struct Mark {
    std::string_view bytes;
    const char* format;
  };
  constexpr std::array<Mark, 13> kMarks = {{{"\x89PNG"sv, "png"},
                                            {"\xff\xd8\xff"sv, "jpeg"},
                                            {"BM"sv, "bmp"},
                                            {"GIF8"sv, "gif"},
                                            {"8BPS"sv, "psd"},
                                            {"II*\0"sv, "tiff"},
                                            {"MM\0*"sv, "tiff"},
                                            {"II+\0"sv, "tiff"},
                                            {"MM\0+"sv, "tiff"},
                                            {"\x76\x2f\x31\x01"sv, "openexr"},
                                            {"#?"sv, "hdr"},
                                            {"DDS "sv, "dds"},
                                            {"\x01\xda"sv, "sgi"}}};
  for (const Mark& mark : kMarks) {
    if (hasAt(start, 0, mark.bytes)) return mark.format;
  }
  if (hasAt(start, 0, "RIFF") && hasAt(start, 8, "WEBP")) return "webp";
  if (start.size() > 2 && start[0] == 'P' && start[1] >= '1' && start[1] <= '6' &&
      std::isspace(start[2]) != 0) {
    return "pnm";
  }
  const std::size_t last = name.size() - std::min<std::size_t>(name.size(), 4);
  return lowerCase(name.substr(last)) == ".tga" ? "targa" : "";
}

std::optional<Size> imageSizeOf(Bytes start, const std::string& format) {
  if (format == "bmp") return bmpSize(start);
  if (format == "webp") return webpSize(start);
  if (format == "gif") return Size{little(start, 6, 2), little(start, 8, 2)};
  if (format == "psd") return Size{big(start, 18), big(start, 14)};
  return std::nullopt;
}

}  // namespace radiosity
