// Reads surfaces of sides of volumes in the input of CalculiX and Abaqus.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/inp/inp_bodies.h"

namespace radiosity {

/// Reads *SURFACE. A surface of the assembly has a part in each instance.
void beginSurface(InpBodies& bodies, const std::string& name);

/// Reads a line "12, S3" or "SET, S3" of the last surface. Other labels (SPOS, EDGE1) are not sides
/// of volumes.
void addSides(InpBodies& bodies, const std::vector<std::string_view>& fields);

}  // namespace radiosity
