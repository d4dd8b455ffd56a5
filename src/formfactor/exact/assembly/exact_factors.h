// The exact method: every pair once, area to area, with the blocked parts clipped off.
#pragma once

#include "formfactor/method.h"

namespace radiosity {

std::unique_ptr<PreparedMethod> prepareExact(const PatchMesh& mesh,
                                             const FormFactorOptions& options);

std::shared_ptr<const ExchangeMatrix> exactRowsForOthers(const PatchMesh& mesh,
                                                         const FormFactorOptions& options,
                                                         Processes& processes, Progress& progress,
                                                         RowJournal* journal);

}  // namespace radiosity
