// What the benchmark looks at.
#pragma once

#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

struct BenchScene {
  std::string name;
  PatchMesh mesh;       ///< meshed with the program's defaults
  PatchMesh fine_mesh;  ///< with four times the patches
};

/// The Cornell box and the cluttered scene of data/.
std::vector<BenchScene> benchScenes();

}  // namespace radiosity::bench
