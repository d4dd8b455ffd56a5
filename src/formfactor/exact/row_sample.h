// What a sample of the rows takes, to foresee what all of them will.
#pragma once

#include <cstddef>

#include "formfactor/exact/exact_scene.h"
#include "formfactor/exact/partial_cost.h"

namespace radiosity {

/// Counts and seconds of a sample, brought to all rows.
struct RowSample {
  double unoccluded = 0;  ///< pairs with nothing in between, or below the horizon
  double partial = 0;     ///< pairs that go to the clipping
  double occluders = 0;   ///< candidates, summed over these
  double shaft_tests = 0;
  PartialCost cost;            ///< of the partial pairs, at the rates of a usual machine
  std::size_t task_bytes = 0;  ///< most that the clipped pairs of a task take, about

  /// Processor seconds as they were measured here and now, for what the counts say.
  double seconds_visibility = 0;
  double seconds_unoccluded = 0;
  double seconds_partial = 0;
  /// How much longer the sample took by the clock: other work on the machine.
  double busy = 1;
};

/// Some rows of up to kSampleSteps tasks against later facets of many elements or of few, each half
/// of the tasks: all of these, or every so many-th where there are very many. The work has a
/// bound, in tests and pairs and not by the clock, so that all but the seconds comes out the same
/// in every run; only the clipping that is timed stops by the clock. (0.05 to 1.2 s on two threads
/// of a 2.7 GHz Xeon, from a spotted cow to a couch among cushions; a single pair may take longer
/// than that where the tolerance is 1e-6 and bodies are round.) Steps `progress` by
/// kSampleSteps; calls its check().
RowSample sampleRows(const ExactScene& scene, const ExactKernels& kernels, double tolerance,
                     Progress& progress);
inline constexpr std::size_t kSampleSteps = 96;

/// The counts alone, without seconds, of a sixth as many tasks. Steps `progress` by
/// kRoughSampleSteps; calls its check().
RowSample sampleRowsRoughly(const ExactScene& scene, double tolerance, Progress& progress);
inline constexpr std::size_t kRoughSampleSteps = 16;

}  // namespace radiosity
