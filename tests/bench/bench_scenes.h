// Scenes of the benchmark: those of data/, meshed.
#pragma once

#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace radiosity::bench {

struct BenchScene {
  std::string name;  ///< of the file in data/
  Scene scene;
  PatchMesh mesh;
};

/// `patches`: about how many; the scene may ask for more.
BenchScene benchScene(const std::string& name, std::size_t patches);

/// For rates: one scene with the program's default number of patches, and with four times as many.
struct RateScene {
  std::string name;
  PatchMesh mesh;
  PatchMesh fine_mesh;
};

/// The Cornell box and the cluttered scene.
std::vector<RateScene> rateScenes();

/// For error against time. `quick`: scenes that take seconds.
struct CurveScene {
  std::string name;
  std::size_t patches;
  /// Error of each value of truth aimed at, in mean form factors 1/N: as fine as running times
  /// bear, and far below what is measured by it.
  double truth_accuracy;
};
std::vector<CurveScene> curveScenes(bool quick);

}  // namespace radiosity::bench
