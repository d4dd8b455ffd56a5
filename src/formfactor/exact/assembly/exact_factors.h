// The exact method: every pair once, area to area, with the blocked parts clipped off.
#pragma once

#include "base/processes.h"
#include "formfactor/exact/assembly/exact_scene.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// See computeFormFactors(). `scene` is the mesh's, `kernels` and `estimate` the scene's; `journal`
/// and `processes` may be null.
FormFactors exactFactors(const PatchMesh& mesh, const ExactScene& scene,
                         const ExactKernels& kernels, const ExactEstimate& estimate,
                         const FormFactorOptions& options, Progress& progress, RowJournal* journal,
                         Processes* processes);

/// For the other processes, while process 0 is in exactFactors(): makes the rows of this one.
ExchangeMatrix exactRowsForOthers(const PatchMesh& mesh, const FormFactorOptions& options,
                                  Processes& processes, Progress& progress, RowJournal* journal);

}  // namespace radiosity
