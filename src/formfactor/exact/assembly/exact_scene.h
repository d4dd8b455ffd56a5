// The mesh prepared for the exact method, and the cost foreseen.
#pragma once

#include "formfactor/exact/assembly/row_assembly.h"
#include "formfactor/exact/assembly/row_tasks.h"
#include "formfactor/exact/occluded/occluded_pairs.h"
#include "formfactor/exact/unoccluded/unoccluded.h"
#include "formfactor/exact/visibility/visibility.h"
#include "formfactor/row_memory.h"
#include "radiosity/form_factors.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

struct ExactScene {
  /// `leading`: see ElementSet. Steps `progress` by kSteps. Throws Cancelled.
  static constexpr std::size_t kSteps = 3;
  ExactScene(const PatchMesh& mesh, Progress& progress, std::span<const std::uint8_t> leading = {});
  /// The first tasks, which hold all elements that lead.
  std::size_t leadingTasks() const;
  ElementSet elements;
  OccluderSet occluders;
  Visibility visibility;
  PatchOrder order;
  RowTasks tasks;
  ColumnChunks chunks;
};

/// The kernels that compute values, in closed form and by clipping, to the options' tolerance.
struct ExactKernels {
  /// Keeps `scene` by reference.
  ExactKernels(const ExactScene& scene, const FormFactorOptions& options);
  double closed_form;  ///< relative error that closed forms hold
  UnoccludedKernel unoccluded;
  OccludedKernel occluded;
};

/// The cost foreseen from the pairs of a sample of tasks. It depends on the scene and the options
/// alone, never on the machine or its load.
struct ExactEstimate {
  RowMemory memory;
  std::size_t matrix_bytes = 0;  ///< of these, the matrix
  double entries_per_row = 0;    ///< at most
  double occluded_pairs = 0;
  double occluders_per_pair = 0;
  double points = 0;    ///< ExactReport::points; about, like the work
  double work = 0;      ///< see foreseen_work.h
  double refining = 0;  ///< the part of the work that goes with 1 / tolerance
};
struct RowSample;
ExactEstimate estimateExact(const ExactScene& scene, const RowSample& sample,
                            const FormFactorOptions& options);
/// Seconds by the clock on the threads allowed, at the rates that the sample has here and now.
/// Pairs are clipped for `clip_seconds`, see timeRows().
double exactSeconds(const ExactScene& scene, const ExactKernels& kernels, const RowSample& sample,
                    const FormFactorOptions& options, double clip_seconds, Progress& progress);

}  // namespace radiosity
