// Which format an image file has and how large it is, by its first bytes: some of OpenImageIO's
// readers unpack a whole image before they say.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace radiosity {

/// Enough of a file for the two below.
inline constexpr std::size_t kImageHeaderBytes = 64;

/// OpenImageIO's name of the format; empty where it is none that is read. Targa has no mark of its
/// own: it is told by the extension of `name`.
std::string imageFormatOf(std::span<const unsigned char> start, const std::string& name);

/// Width and height where the format is one that is unpacked when it is opened (BMP, GIF, PSD,
/// WebP); of the others OpenImageIO tells them before it reads pixels.
std::optional<std::pair<std::size_t, std::size_t>> imageSizeOf(std::span<const unsigned char> start,
                                                               const std::string& format);

}  // namespace radiosity
