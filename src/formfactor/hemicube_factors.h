// The hemicube method: one look a patch.
#pragma once

#include "radiosity/form_factors.h"

namespace radiosity {

/// Raw rows, as they were seen, unless `symmetrize`. See computeFormFactors().
FormFactors hemicubeFactors(const PatchMesh& mesh, const FormFactorOptions& options,
                            Progress& progress);

/// Bytes hemicubeFactors() will hold at once, from a sample of rows.
std::size_t hemicubeBytes(const PatchMesh& mesh, const FormFactorOptions& options);

}  // namespace radiosity
