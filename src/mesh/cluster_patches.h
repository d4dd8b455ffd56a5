// Patches that share an unknown, where a scene has more of them than were asked for.
#pragma once

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Patches, both sides counted once, above this many times what was asked for share unknowns.
constexpr double kMostPatchesKept = 1.2;

/// Face clusters (Willmott, Heckbert & Garland, "Face Cluster Radiosity", 1999): `wanted` of them,
/// both sides counted once, or as many as there are surfaces, if that is more. Patches of one
/// surface that share an edge, or lie next to each other in space, are put together by
/// Agglomeration, the cheapest pair first: patches that are large keep an unknown of their own, a
/// small body becomes one. The back of a cluster is the backs of its patches. No patch is
/// degenerate. The result does not depend on how patches are numbered, but for their order within a
/// surface. n log n. Throws Cancelled.
///
/// Bodies that do not touch are put together from the start, not only when each has become one
/// cluster: of books in a row, the sides that face each other belong together rather than the sides
/// and the back of one book, which have other light (in data/furnished-room.obj, 2,000 clusters of
/// 3,748 patches, powers of surfaces are off by 0.9% so and by 5% otherwise).
PatchClusters clusterPatches(const PatchMesh& mesh, std::size_t wanted, Progress& progress);

/// The clusters that `of_patch`, which names each patch's, tells of: `count` of them, none empty.
PatchClusters clustersOf(std::vector<Index> of_patch, std::size_t count);

/// Gives a mesh that has too many patches for `options` its clusters, and says so in the report.
void shareUnknowns(PatchMesh& mesh, const MeshOptions& options, MeshReport& report,
                   Progress& progress);

}  // namespace radiosity
