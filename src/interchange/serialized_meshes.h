// Mitsuba's file of meshes.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "interchange/exported_parts.h"

namespace radiosity {

/// The meshes in one file, by number, in double precision ("serialized", version 4: Mitsuba 0.6
/// documentation, 8.1.4, and Mitsuba 3's plugin of that name). `names`: one a mesh.
std::vector<std::byte> serializedMeshes(std::span<const SurfaceTriangles> meshes,
                                        std::span<const std::string> names);

}  // namespace radiosity
