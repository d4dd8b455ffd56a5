// Images of skies for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "radiosity/base.h"

namespace radiosity::test {

/// The bytes of a picture in Radiance's format (RGBE, not packed): at(x, y) from the top left. A
/// pixel's largest colour has eight bits.
template <class At>
std::string radianceHdr(int width, int height, const At& at) {
  std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
                      " +X " + std::to_string(width) + "\n";
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec3 rgb = at(x, y);
      int exponent = 0;
      std::frexp(std::max({rgb.x, rgb.y, rgb.z}), &exponent);
      const double scale = std::ldexp(1, 8 - exponent);
      for (const double value : {rgb.x, rgb.y, rgb.z}) bytes += char(int(value * scale));
      bytes += char(exponent + 128);
    }
  }
  return bytes;
}

}  // namespace radiosity::test
