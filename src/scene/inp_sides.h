// Surfaces of sides of volumes, as lines of CalculiX's and Abaqus' input list them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/inp_bodies.h"

namespace radiosity {

/// *SURFACE. One of the assembly is a share for each instance.
void beginSurface(InpBodies& bodies, const std::string& name);

/// A line "12, S3" or "SET, S3" of the surface begun last. Other labels (SPOS, EDGE1) are no sides
/// of volumes.
void addSides(InpBodies& bodies, const std::vector<std::string_view>& fields);

}  // namespace radiosity
