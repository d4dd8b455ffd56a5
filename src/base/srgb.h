// The transfer function of sRGB (IEC 61966-2-1:1999), [0, 1] -> [0, 1], one channel.
#pragma once

#include <cmath>

namespace radiosity {

/// The linear light that a file's sRGB-coded value stands for.
inline double linearFromSrgb(double coded) {
  return coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4);
}

/// The sRGB-coded value of linear light.
inline double srgbFromLinear(double linear) {
  return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Coded values from here on round to 255, which may also stand for any brighter light.
inline constexpr double kBrightestByte = 254.5 / 255;

}  // namespace radiosity
