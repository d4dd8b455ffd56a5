// The brightness of colours.
#pragma once

#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Luminance of one unit of each band of linear RGB (Rec. ITU-R BT.709).
inline constexpr double kLuminanceOfRed = 0.2126;
inline constexpr double kLuminanceOfGreen = 0.7152;
inline constexpr double kLuminanceOfBlue = 0.0722;

/// Relative luminance of linear RGB.
inline double luminanceOf(const Vec3& rgb) {
  return kLuminanceOfRed * rgb.x + kLuminanceOfGreen * rgb.y + kLuminanceOfBlue * rgb.z;
}

/// One number for a value of any bands: the luminance of three, else the sum of all.
inline double brightnessOf(std::span<const double> bands) {
  if (bands.size() == 3) return luminanceOf({bands[0], bands[1], bands[2]});
  return std::accumulate(bands.begin(), bands.end(), 0.0);
}

/// The same of each row of N * bands values: N.
inline std::vector<double> brightnessOfEach(std::span<const double> rows, int bands) {
  const auto width = std::size_t(bands);
  std::vector<double> values(rows.size() / width);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = brightnessOf(rows.subspan(width * i, width));
  }
  return values;
}

/// The words for brightnessOf() with this many bands, which follow the name of a quantity.
inline std::string brightnessText(int bands) {
  if (bands == 3) return " (Rec. 709 luminance)";
  return bands == 1 ? "" : " (sum of all bands)";
}

}  // namespace radiosity
