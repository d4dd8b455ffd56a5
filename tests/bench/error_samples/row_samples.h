// Errors of whole rows, and of closed forms over a row.
#pragma once

#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

/// For each tolerance, of all rows, against the matrix at tolerance `reference`:
///
///     row tolerance error figure recheck
///     points tolerance pairs foreseen counted
///     closed error
///
/// `recheck`: ErrorSums::recheckRatio(). `points`: of all occluded pairs. `closed`:
/// of a row's values with nothing in between, relL2, over what they are held to.
void sampleRows(const PatchMesh& mesh, double reference, const std::vector<double>& tolerances);

}  // namespace radiosity::bench
