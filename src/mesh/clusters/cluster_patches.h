// Clusters of patches that share an unknown, for scenes with more patches than asked for.
#pragma once

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Patches share unknowns if their number, both sides counted once, is more than this times the
/// number asked for.
constexpr double kMostPatchesKept = 1.2;

/// Face clusters (Willmott, Heckbert & Garland, "Face Cluster Radiosity", 1999): `wanted` of them,
/// both sides counted once, or as many as there are surfaces, if that is more. Agglomeration joins
/// patches of one surface that share an edge or are next to each other in space, the cheapest pair
/// first: large patches keep an unknown of their own, a small body becomes one. The back of a
/// cluster consists of the backs of its patches. Of a mesh that has clusters, these are joined. A
/// degenerate patch stays alone. The result
/// depends on the numbers of patches only through their order within a surface. O(n log n). Throws
/// Cancelled.
///
/// Bodies that do not touch are joined from the start, not only when each has become one cluster.
/// In a row of books, sides that face each other belong together: the other sides of a book have
/// other light (in data/furnished-room.obj, 2,000 clusters of 3,748 patches, powers of surfaces are
/// off by 0.9% with this, and by 5% without).
PatchClusters clusterPatches(const PatchMesh& mesh, std::size_t wanted, Progress& progress);

/// Makes `count` clusters from the cluster of each patch, `of_patch`. No cluster is empty.
PatchClusters clustersOf(std::vector<Index> of_patch, std::size_t count);

/// Gives a mesh clusters if it has too many patches for `options`, and notes it in the report.
void shareUnknowns(PatchMesh& mesh, const MeshOptions& options, MeshReport& report,
                   Progress& progress);

}  // namespace radiosity
