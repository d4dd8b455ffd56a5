// Surfaces joined under one name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Groups of surfaces. Tables and conditions of heat use them; patches and form factors do not.
struct SurfaceGroups {
  std::vector<std::string> names;  ///< the groups in the order given, then surfaces without one
  std::size_t groups = 0;          ///< the number of names that are of groups
  std::vector<Index> of_surface;   ///< into names, by surface
  std::vector<Note> notes;         ///< surfaces that match more than one group
};

/// Each of `groups` is "NAME=PATTERN". PATTERN is the name of a surface ("object/material") or a
/// pattern of the shell: * any text (slashes too), ? a character, [abc] one of some. A surface goes
/// to the first group that matches it; a NAME given again adds to its group; a surface without a
/// group is under its own name. Errors: InputError naming the option, for any other text, a pattern
/// that matches nothing (with the existing names), a group left without a surface, and a group that
/// has the name of a surface outside it.
SurfaceGroups groupSurfaces(std::span<const std::string> surfaces,
                            std::span<const std::string> groups = {});

}  // namespace radiosity
