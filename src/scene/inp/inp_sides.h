// Reads surfaces of sides of volumes and shells in the input of CalculiX and Abaqus.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/inp/inp_bodies.h"

namespace radiosity {

/// Reads *SURFACE. A surface of the assembly has a part in each instance.
void beginSurface(InpBodies& bodies, const std::string& name);

/// Reads a line "12, S3" or "SET, S3" of the last surface, of shells "SET, SPOS", "SET, SNEG" or
/// "SET". Other labels (EDGE1) are no sides.
void addSides(InpBodies& bodies, const std::vector<std::string_view>& fields);

}  // namespace radiosity
