// Cells, parts and far targets of a scene's occluded pairs, with converged values.
#pragma once

#include <cstddef>

#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

/// Of about `pairs` occluded pairs, drawn from a fixed seed, that neither element's plane
/// cuts, at several tolerances; everything as a share of the cell's, or pair's, whole form factor:
///
///     cell tolerance level one_shape may_cross one_occluder fraction change error cautious stated
///          allowed outside residual...
///     part tolerance one_shape near overlap difference before values error estimate passes
///     far distance fraction difference
///
/// `cell`: cells that the rules come to, one quarter of each that is cut. `allowed`: the cautious
/// estimate that is accepted. `outside`: the largest residual near the corners, or -1: it was not
/// looked at. 4 residuals or 9. `part`: of pairs cut along critical lines, before any is halved.
/// `difference`: of the two rules; `before`: of the first and a single point; `values`: the largest
/// residual times the area. `far`: the change of a visible fraction by the kernels for far targets,
/// with 2 x 2 points, targets 2 to 4 radii away.
void sampleScene(const PatchMesh& mesh, std::size_t pairs);

}  // namespace radiosity::bench
