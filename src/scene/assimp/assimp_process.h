// Assimp in a process of its own (src/assimp): damaged files make it crash, or ask for all the
// memory there is.
#pragma once

#include <string>

#include "scene/assimp/assimp_scene.h"

namespace radiosity {

struct AssimpAnswer {
  AssimpScene scene;  ///< its indices are in range
  std::string why;    ///< if it is not empty, why Assimp cannot read the file
};

/// Errors: InputError naming `file` if the process ends before it answers, by a fault or a limit;
/// RunError if it cannot be started; Cancelled if a person ended it.
AssimpAnswer readByAssimp(const std::string& file);

}  // namespace radiosity
