// Form factors by several processes: what process 0 tells the others, and what they do.
#pragma once

#include "base/processes.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// Errors: InputError, with the cure, where these form factors cannot be shared.
void requireShareable(const PatchMesh& mesh, const FormFactorOptions& options);

/// By process 0 in computeFormFactors(), before rows are computed; the others are in
/// shareFormFactors().
void tellOthers(Processes& processes, const PatchMesh& mesh, FormFactorMethod method,
                const FormFactorOptions& options);

/// By the others, while process 0 is in computeFormFactors(): computes a share of the rows and
/// returns them, all others empty. `mesh`: the same as process 0's, else RunError. `journal`: as of
/// computeFormFactors(), this process's own; may be null.
ExchangeMatrix shareFormFactors(const PatchMesh& mesh, Processes& processes, Progress& progress,
                                RowJournal* journal);

}  // namespace radiosity
