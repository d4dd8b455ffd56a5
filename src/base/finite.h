// Whether coordinates are numbers.
#pragma once

#include <cmath>

#include "radiosity/base.h"

namespace radiosity {

inline bool isFinite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace radiosity
