// The axis that points up, as a direction.
#pragma once

#include "radiosity/light_traits.h"

namespace radiosity {

inline Vec3 upVector(Up up) { return up == Up::y ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

}  // namespace radiosity
