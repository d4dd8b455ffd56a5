// Form factors by rays whose rows are cut through a tree of patches.
#pragma once

#include <memory>

#include "formfactor/method.h"

namespace radiosity {

/// Rows of rays, as many for each as FormFactorOptions::toleranceOf(cut) of irradiance asks for by
/// a sample under trial lights; the matrix is a CutOperator. Rows that are known need no rays.
std::unique_ptr<PreparedMethod> prepareCut(const PatchMesh& mesh, const FormFactorOptions& options);

}  // namespace radiosity
