// Assimp's vectors from and to ours.
#pragma once

#include <assimp/types.h>

#include <array>

#include "radiosity/base.h"

namespace radiosity {

inline aiVector3D vectorOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
inline Vec3 doublesOf(const aiVector3D& v) { return {double(v.x), double(v.y), double(v.z)}; }

}  // namespace radiosity
