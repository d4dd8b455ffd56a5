// Rewrites X3D for Assimp, which loses all copies of a shape but one, takes the first material of a
// file for shapes without any, and skips viewpoints, units and most grouping nodes.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// The prefixes of the names of groups with a shape that has solid="false", or ccw="false".
inline constexpr std::string_view kX3dTwoSided = "$two-sided$";
inline constexpr std::string_view kX3dClockwise = "$clockwise$";

/// The parts of a file that Assimp drops.
struct X3dExtras {
  double metres_per_unit = 1;
  std::vector<Camera> viewpoints;  ///< in units; the angle is the vertical one
};

/// The string that stands at the start of `text` in quotes, or the whole text.
std::string withoutQuotes(std::string_view text);

/// Rewrites the elements in place. USE becomes a copy of the named element. Anchor, Billboard,
/// Collision, CAD nodes and layers become Group, and LOD becomes its finest level. A shape with a
/// name, with solid="false" or with ccw="false" gets a Group that says so, and one without
/// Appearance gets an empty one. Cone and Cylinder, whose faces Assimp turns both ways, become an
/// IndexedFaceSet of 32 sides. Of a list of places the first stays. Notes parts that Assimp does
/// not read. `document` must have passed checkXml(). ISO/IEC 19775-1 and 19776-1.
X3dExtras rewriteX3d(pugi::xml_document& document, FeatureNotes& notes);

}  // namespace radiosity
