// Rewrites X3D for Assimp, which loses all copies of a shape but one, takes the first material of a
// file for shapes without any, and skips names, viewpoints, units and most grouping nodes.
#pragma once

#include <cstddef>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/scene.h"
#include "scene/scene_builder.h"

namespace radiosity {

/// What Assimp drops of a shape.
struct X3dShape {
  std::string name;      ///< its own or that of the nearest element above it that has one
  std::string material;  ///< the name of its Material or Appearance
  bool two_sided = false;
  bool clockwise = false;  ///< the fronts of its faces
};

/// The number of the shape in a group with this name, which rewriteX3d() has made; else nothing.
std::optional<std::size_t> x3dShapeNumber(std::string_view group);

/// The parts of a file that Assimp drops.
struct X3dExtras {
  double metres_per_unit = 1;
  std::vector<Camera> viewpoints;  ///< in units; the angle is the vertical one
};

/// The string that stands at the start of `text` in quotes, or the whole text.
std::string withoutQuotes(std::string_view text);

/// Rewrites the elements in place. USE becomes a copy of the named element. Anchor, Billboard,
/// Collision, CAD nodes and layers become Group, and LOD becomes its finest level. A shape is
/// appended to `shapes` and gets a Group, whose name has its number there. One without Appearance
/// gets an empty one. Cone and Cylinder, whose faces Assimp turns both ways, become an
/// IndexedFaceSet of 32 sides. Of a list of places the first stays. Notes parts that Assimp does
/// not read. `document` must have passed checkXml(). ISO/IEC 19775-1 and 19776-1.
X3dExtras rewriteX3d(pugi::xml_document& document, std::vector<X3dShape>& shapes,
                     FeatureNotes& notes);

}  // namespace radiosity
