// The patches that clusters see, for any light: PatchIrradiance for callers without rays.
#pragma once

#include <cstdint>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Sums over the rays of PatchIrradiance. Its least-squares fit in any light follows from them. The
/// axes of a cluster are combinations of place and normal with a mean of 0 over the cluster's rays,
/// a mean square of 1 and no correlation. So the slope of irradiance along an axis is the mean over
/// all rays of the radiosity found times the axis' value where the ray left.
///
/// Backs are black and left out. *Test:* rays_patch_irradiance_test.
struct SeenPatches {
  std::vector<std::uint32_t> begin;  ///< K + 1, into `item` and `hits`
  std::vector<std::uint32_t> item;   ///< increasing in a row: a patch, or N: the sky
  std::vector<std::uint32_t> hits;   ///< rays that end there
  std::vector<std::uint32_t> rays;   ///< K: all rays of the cluster, those that end on backs too
  std::vector<std::uint8_t> axes;    ///< K: 0 (one patch alone, or no area) to 6
  /// Item by item, a value for each axis of its row: the mean over the rays that end there.
  std::vector<float> mean;
  /// Patch by patch, a value for each axis of its cluster: the patch's own, less the mean by area
  /// over the cluster.
  std::vector<float> patch;
};

/// `mesh` has clusters. The same bits for any number of threads. Throws Cancelled.
SeenPatches seenPatches(const PatchMesh& mesh, Progress& progress);

}  // namespace radiosity
