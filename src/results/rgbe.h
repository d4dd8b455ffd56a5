// Radiance's picture format: a shared exponent for three colours.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "radiosity/render.h"

namespace radiosity {

/// A colour as Radiance stores it: mantissas of eight bits, cut off, and an exponent, so that the
/// largest of three is known to 1/128. Readers of Radiance add half a step. Below 1e-32 it is
/// black. G. Ward, "Real Pixels", Graphics Gems II, 1991.
std::array<std::uint8_t, 4> rgbeOf(const std::array<float, 3>& colour);

/// Writes an image, colours multiplied by alpha, with a header of `metadata` as NAME=VALUE, the
/// bands' primaries and Radiance's VIEW= if it is among them. Errors: RunError for a colour below 0
/// or too large, or if the file cannot be written.
void writeRgbe(const std::string& path, const Image& image,
               std::span<const std::pair<std::string, std::string>> metadata);

}  // namespace radiosity
