// The exact rows of unknowns that emit, beside which rays or hemicubes make all others.
#pragma once

#include <memory>
#include <optional>

#include "formfactor/exact/assembly/leading_rows.h"
#include "formfactor/method.h"

namespace radiosity {

struct EmitterRows {
  std::optional<PatchMesh> patches;  ///< if the method makes rows of clusters' patches: these alone
  std::optional<LeadingRows> rows;   ///< of them, or of the mesh
  double seconds = 0;                ///< for preparing these

  KnownRows compute(Progress& progress) const;
};

/// Prepares the rows of FormFactorOptions::exact_rows beside `method`, and adds what they take to
/// its plan. Null if there are none, the method takes none, or they are too much work beside it.
/// `mesh` is kept by reference.
std::unique_ptr<const EmitterRows> planEmitterRows(const PatchMesh& mesh,
                                                   const FormFactorOptions& options,
                                                   const PreparedMethod& method,
                                                   FormFactorPlan& plan, Progress& progress);

}  // namespace radiosity
