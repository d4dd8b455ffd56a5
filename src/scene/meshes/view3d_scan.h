// Reads a View3D input file, F = 3 and F = 3a (Walton & DeGraw, "View3D User Manual", version 3.3,
// section 5), token by token.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

struct View3dSurface {
  enum class Kind { radiating, mask, null, obstruction };
  Kind kind = Kind::radiating;
  std::size_t line = 0;
  std::vector<Index>
      corners;           ///< 3 or 4, into View3dScan::vertices, counter-clockwise from the front
  std::size_t base = 0;  ///< number of the surface in which it lies, counted from 1; 0: none
  std::size_t combined = 0;  ///< number of the surface of which it is a part, likewise
  double emissivity = 1;     ///< 0 to 1
  std::string name;
};

struct View3dScan {
  std::vector<Vec3> vertices;  ///< file units
  std::vector<View3dSurface> surfaces;
  std::vector<Note> notes;
};

/// Errors: InputError "FILE:LINE: what is wrong; cure". References between surfaces are valid and
/// in the order that View3D requires.
View3dScan scanView3d(const std::string& file, std::string_view text);

}  // namespace radiosity
