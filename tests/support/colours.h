// Values of three bands as colours.
#pragma once

#include <vector>

#include "radiosity/base.h"

namespace radiosity::test {

/// The i-th of rows of three.
inline Vec3 rgbAt(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}
inline void setRgb(std::vector<double>& values, std::size_t i, const Vec3& rgb) {
  for (int b = 0; b < 3; ++b) values[3 * i + std::size_t(b)] = rgb[b];
}

}  // namespace radiosity::test
