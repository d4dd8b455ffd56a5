// Lights under which rows that are cut are tried.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/rays/ray_scene.h"
#include "matrix/patch_tree.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

inline constexpr int kTrials = 4;

/// Of each patch, kTrials values each.
struct TrialLights {
  /// What falls on it anyway, which rows do not bring: errors are relative to all light. 0 where
  /// they are to be relative to what rows bring.
  std::vector<double> direct;
  std::vector<double> radiosity;  ///< what rows bring: half of `direct` is reflected
  /// The irradiance of a place that sees nothing but sky: rays bring it, not `direct`.
  std::array<double, kTrials> sky{};
};

/// If some patches are known to emit: what these give to all others directly, taken to be alike
/// by area; one trial then. The rows bring what is reflected: emitters' own are known. Else suns
/// where a ray from some patch finds the sky, and lamps in mid-air where it finds a wall: those of
/// many that reach most of the area, with their shadows. Nobody knows whether they are like the
/// scene's, so errors are relative to what rows bring. Of `sources`, which light at points alone is
/// made from, they are relative to all light, and an even sky is one of the trials if some ray
/// finds it. Throws Cancelled.
TrialLights trialLights(const PatchMesh& mesh, const RayScene& scene, const PatchTree& tree,
                        std::span<const Index> emitters, bool sources, std::uint64_t seed,
                        Progress& progress);

/// Some patches of a tree, by place: of each part of it as many.
std::vector<std::size_t> someOf(const PatchTree& tree);

}  // namespace radiosity
