// How bright a colour is.
#pragma once

#include "radiosity/base.h"

namespace radiosity {

/// Relative luminance of linear RGB (Rec. ITU-R BT.709).
inline double luminanceOf(const Vec3& rgb) {
  return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

}  // namespace radiosity
