// Scenes that error figures are scored on and were not fitted to.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

struct FigureScene {
  std::string name;
  std::size_t patches = 0;  ///< about how many
  std::function<Scene()> make;
};

/// Points that agree by symmetry (boxes in boxes), shadows that begin at the sampled patch
/// (touching boxes), thin shadows (slivers), and meshes of the Cornell box and of two rooms that
/// the curves do not have.
std::vector<FigureScene> figureScenes();

}  // namespace radiosity::bench
