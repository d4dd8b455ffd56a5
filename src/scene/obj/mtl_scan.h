// Reads an MTL file token by token.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_builder.h"

namespace radiosity {

/// A map_Kd or map_Ke.
struct MtlMap {
  std::string file;    ///< as written, including blanks; may be empty
  bool clamp = false;  ///< else it repeats
  bool moved = false;  ///< -s, -o or -t has an effect
};

struct MtlMaterial {
  std::string name;
  std::size_t line = 0;
  std::optional<Vec3> reflectance{};  ///< Kd as written, settledReflectance()
  std::optional<Vec3> radiance{};     ///< Ke as written
  std::string out_of_range{};         ///< FILE:LINE of a Kd or Ke that is no such value; else empty
  std::optional<MtlMap> reflectance_map{};
  std::optional<MtlMap> radiance_map{};
};

/// The materials in file order; none if nothing in the text defines one, in which case nothing of
/// it is quoted: an OBJ may name any file. Features that a diffuse solver does not use go to
/// `ignored`, by material name. Kd, Ke and their maps may also be in small letters. Errors:
/// InputError "FILE:LINE: what is wrong; cure".
std::vector<MtlMaterial> scanMtl(const std::string& file, std::string_view text,
                                 FeatureNotes& ignored);

}  // namespace radiosity
