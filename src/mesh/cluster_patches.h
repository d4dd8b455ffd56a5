// Patches that share an unknown, where a scene has more of them than were asked for.
#pragma once

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Patches, both sides counted once, above this many times what was asked for share unknowns.
constexpr double kMostPatchesKept = 1.2;

/// Face clusters (Willmott, Heckbert & Garland, "Face Cluster Radiosity", 1999): `wanted` of them,
/// both sides counted once, or as many as there are surfaces, if that is more. Patches of one
/// surface that lie near each other and face alike are put together by Agglomeration: first those
/// that share an edge, as long as a cluster stays bounded in size and nearly flat; then, where
/// clusters are still too many, bent ones as well, so that a small body may become one; then
/// neighbours without a common edge; then whatever costs least. The back of a cluster is the backs
/// of its patches. No patch is degenerate. The result does not depend on how patches are numbered,
/// but for their order within a surface. n log n. Throws Cancelled.
PatchClusters clusterPatches(const PatchMesh& mesh, std::size_t wanted, Progress& progress);

/// Gives a mesh that has too many patches for `options` its clusters, and says so in the report.
void shareUnknowns(PatchMesh& mesh, const MeshOptions& options, MeshReport& report,
                   Progress& progress);

}  // namespace radiosity
