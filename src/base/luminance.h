// How bright a colour is.
#pragma once

#include <numeric>
#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// Relative luminance of linear RGB (Rec. ITU-R BT.709).
inline double luminanceOf(const Vec3& rgb) {
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

/// One number for a value of any bands: the luminance of three, else the sum of all.
inline double brightnessOf(std::span<const double> bands) {
  if (bands.size() == 3) return luminanceOf({bands[0], bands[1], bands[2]});
  return std::accumulate(bands.begin(), bands.end(), 0.0);
}

}  // namespace radiosity
