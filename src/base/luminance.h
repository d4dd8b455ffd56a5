// How bright a colour is.
#pragma once

#include "radiosity/base.h"

namespace radiosity {

/// What a unit of each band of linear RGB adds to luminance (Rec. ITU-R BT.709).
inline constexpr double kLuminanceOfRed = 0.2126;
inline constexpr double kLuminanceOfGreen = 0.7152;
inline constexpr double kLuminanceOfBlue = 0.0722;

/// Relative luminance of linear RGB.
inline double luminanceOf(const Vec3& rgb) {
  return kLuminanceOfRed * rgb.x + kLuminanceOfGreen * rgb.y + kLuminanceOfBlue * rgb.z;
}

}  // namespace radiosity
