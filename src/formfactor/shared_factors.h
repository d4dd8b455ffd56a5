// Form factors by several processes: the task that process 0 tells the others, and their share.
#pragma once

#include "base/processes.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// Throws InputError, with the cure, if these form factors cannot be shared.
void requireShareable(const FormFactorOptions& options);

/// Called by process 0 in computeFormFactors(), before rows are computed, while the others are in
/// shareFormFactors().
void tellOthers(Processes& processes, const PatchMesh& mesh, FormFactorMethod method,
                FormFactorOptions options);

/// Called by the others while process 0 is in computeFormFactors(): computes a share of the rows
/// and returns them, all others empty. `mesh`: the same as process 0's, else RunError. `journal`:
/// this process's own, as of computeFormFactors(); may be null.
std::shared_ptr<const ExchangeMatrix> shareFormFactors(const PatchMesh& mesh, Processes& processes,
                                                       Progress& progress, RowJournal* journal);

}  // namespace radiosity
