// Reads an MTL file token by token before the library does (see obj_scan.h).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_builder.h"

namespace radiosity {

struct MtlMaterial {
  std::string name;
  std::size_t line = 0;
  std::optional<Vec3> reflectance;  ///< Kd as written
  std::optional<Vec3> radiance;     ///< Ke as written
  bool textured = false;            ///< has a map_Kd
  bool glows = false;               ///< has a map_Ke
};

struct MtlScan {
  std::vector<MtlMaterial> materials;  ///< in file order
  std::string text;                    ///< statements, one a line: what the library gets to see
};

/// Features that a diffuse solver leaves out go to `ignored`, by material name.
/// Errors: InputError "FILE:LINE: what is wrong; cure".
MtlScan scanMtl(const std::string& file, std::string_view text, FeatureNotes& ignored);

}  // namespace radiosity
