// Keyword lines in input of CalculiX and Abaqus, and the element types in them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/grouped_faces.h"

namespace radiosity {

/// A line `*WORD, NAME=VALUE, NAME`: word and names in small letters.
struct InpKeyword {
  std::string word;
  std::map<std::string, std::string> parameters;

  std::string get(const std::string& name) const {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::string() : found->second;
  }
  bool has(const std::string& name) const { return parameters.contains(name); }
};

/// The fields of a data line, between commas that are not in quotation marks.
std::vector<std::string_view> inpFields(std::string_view line);

/// Parses a keyword line; `line` begins with a star.
InpKeyword inpKeyword(std::string_view line);

/// The shape of shells, membranes, rigid and other surfaces, and of flat solids, which Gmsh writes
/// for faces. `type`: in small letters. Empty for volumes, beams and the rest.
std::optional<ElementShape> inpFace(const std::string& type);

/// The shape of volumes: solids, heat transfer (D), acoustics (A) and fluids (F). The letters after
/// the number of nodes (C3D20RBR), which specify the integration, are ignored.
std::optional<ElementShape> inpVolume(const std::string& type);

}  // namespace radiosity
