// Finds the format and size of an image file from its first bytes: some of OpenImageIO's readers
// unpack the whole image before they tell the size.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace radiosity {

/// The number of bytes of a file that the functions below need.
inline constexpr std::size_t kImageHeaderBytes = 64;

/// OpenImageIO's name of the format; empty for a format that we do not read. Targa has no
/// signature: it is recognised by the extension of `name`.
std::string imageFormatOf(std::span<const unsigned char> start, const std::string& name);

/// Width and height of an image in a format that OpenImageIO unpacks when it opens the file (BMP,
/// GIF, PSD, WebP). For other formats OpenImageIO tells the size before it reads pixels.
std::optional<std::pair<std::size_t, std::size_t>> imageSizeOf(std::span<const unsigned char> start,
                                                               const std::string& format);

}  // namespace radiosity
