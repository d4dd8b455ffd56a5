// Lines of keywords in input of CalculiX and Abaqus, and the types of elements that they name.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

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

/// `line` begins with a star.
InpKeyword inpKeyword(std::string_view line);

/// Shells, membranes, rigid and other surfaces by their types, and flat solids, as which Gmsh
/// writes faces; `type` in small letters. Nothing for volumes, beams and the rest.
std::optional<ElementShape> inpFace(const std::string& type);

/// Volumes of solids, heat transfer (D), acoustics (A) and fluids (F), whatever the letters behind
/// their number of nodes (C3D20RBR) say of their integration.
std::optional<ElementShape> inpVolume(const std::string& type);

}  // namespace radiosity
