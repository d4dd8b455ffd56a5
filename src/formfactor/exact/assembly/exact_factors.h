// The exact method: every pair once, area to area, what is blocked taken off by clipping.
#pragma once

#include "formfactor/exact/assembly/exact_scene.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// See computeFormFactors(). `scene` is the mesh's, `kernels` and `estimate` the scene's; `journal`
/// may be null.
FormFactors exactFactors(const PatchMesh& mesh, const ExactScene& scene,
                         const ExactKernels& kernels, const ExactEstimate& estimate,
                         const FormFactorOptions& options, Progress& progress, RowJournal* journal);

}  // namespace radiosity
