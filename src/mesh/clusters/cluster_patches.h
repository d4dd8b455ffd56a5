// Clusters of patches that are near each other and face alike: nodes to sum form factors over.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Each patch is in one cluster, with others of its surface and side.
struct PatchClusters {
  std::vector<Index> of_patch;     ///< N, each patch's cluster
  std::vector<std::size_t> begin;  ///< K + 1, into patches
  std::vector<Index> patches;      ///< cluster by cluster, ascending in each

  std::size_t size() const { return begin.empty() ? 0 : begin.size() - 1; }
  std::span<const Index> patchesOf(std::size_t cluster) const {
    return {patches.data() + begin[cluster], begin[cluster + 1] - begin[cluster]};
  }
};

/// Face clusters (Willmott, Heckbert & Garland, "Face Cluster Radiosity", 1999): `wanted` of them,
/// both sides counted once, or as many as there are surfaces, if that is more. Agglomeration joins
/// patches of one surface that share an edge or are next to each other in space, the cheapest pair
/// first: large patches stay alone, a small body becomes one. The back of a cluster consists of the
/// backs of its patches. A degenerate patch stays alone. The result depends on the numbers of
/// patches only through their order within a surface. O(n log n). Throws Cancelled.
///
/// Bodies that do not touch are joined from the start, not only when each has become one cluster.
/// In a row of books, sides that face each other belong together: the other sides of a book have
/// other light.
PatchClusters clusterPatches(const PatchMesh& mesh, std::size_t wanted, Progress& progress);

}  // namespace radiosity
