// What the exact method makes of a mesh before it computes anything, and what that will cost.
#pragma once

#include "formfactor/exact/elements.h"
#include "formfactor/exact/occluders.h"
#include "formfactor/exact/row_assembly.h"
#include "formfactor/exact/row_tasks.h"
#include "formfactor/exact/visibility.h"
#include "radiosity/form_factors.h"

namespace radiosity {

struct ExactScene {
  explicit ExactScene(const PatchMesh& mesh);
  ElementSet elements;
  OccluderSet occluders;
  Visibility visibility;
  PatchOrder order;
  RowTasks tasks;
  ColumnChunks chunks;
};

/// From the pairs of a sample of tasks.
struct ExactEstimate {
  std::size_t bytes = 0;       ///< held at once
  double entries_per_row = 0;  ///< at most
  double partial_pairs = 0;
  double occluders_per_partial = 0;
  double points = 0;    ///< ExactReport::points; about, like the seconds
  double seconds = 0;   ///< of one core, at the rates of a usual machine
  double refining = 0;  ///< of the seconds, those that go with 1 / tolerance
};
ExactEstimate estimateExact(const ExactScene& scene, const FormFactorOptions& options);

}  // namespace radiosity
