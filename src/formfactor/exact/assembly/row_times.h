// Times the work of a sample of the rows, here and now.
#pragma once

#include "formfactor/exact/assembly/row_sample.h"

namespace radiosity {

/// Processor seconds of all rows, foreseen from those of the sample.
struct RowTimes {
  double visibility = 0;
  double unoccluded = 0;
  double occluded = 0;
  /// The sample's time by the clock over that of processors: other work on the machine.
  double busy = 1;
};

/// Evaluates unoccluded blocks and clips pairs of the sample, these for `clip_seconds` of
/// processors' time, or a few times that where there are very many. (A single pair may take longer
/// where the tolerance is 1e-6 and bodies are round.) Calls check() of `progress`.
RowTimes timeRows(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
                  double clip_seconds, const RowSample& sample, Progress& progress);

}  // namespace radiosity
