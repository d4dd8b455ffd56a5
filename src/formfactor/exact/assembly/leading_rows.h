// The exact rows of a few patches, without those of all others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/exact/assembly/exact_scene.h"
#include "formfactor/exact/assembly/row_sample.h"
#include "formfactor/known_rows.h"
#include "radiosity/form_factors.h"

namespace radiosity {

/// A mesh prepared for the exact rows of some patches: their polygons lead, so that their rows of
/// the triangle hold every pair that they are an end of.
class LeadingRows {
 public:
  /// `wanted`: patches, ascending, each once. `mesh` is kept by reference. Steps `progress` by
  /// ExactScene::kSteps. Throws Cancelled.
  LeadingRows(const PatchMesh& mesh, std::vector<Index> wanted, const FormFactorOptions& options,
              Progress& progress);

  /// The tolerance of compute(), which replaces that of the options.
  void setTolerance(double tolerance) { options_.tolerance = tolerance; }
  /// A sample of the rows, for work() and seconds().
  RowSample sample(Progress& progress) const;
  /// The work of compute() to the tolerance set, foreseen as ExactEstimate::work: the same in every
  /// run. Sets the sample's cost, and how many pairs compute() evaluates again.
  double work(RowSample& sample);
  /// The seconds of compute() by the clock, here and now, from a sample given to work().
  double seconds(const RowSample& sample, Progress& progress) const;
  /// Bytes held by compute() beside this, about.
  std::size_t bytes() const;

  /// After work(): a row for each wanted unknown; no rows if none of these has elements. The same
  /// bits for any number of threads. Throws Cancelled.
  std::vector<KnownRow> compute(Progress& progress) const;

 private:
  struct Triangle;
  /// Makes the rows that lead. Returns what errors are to be raised by (ErrorSums).
  double fill(Triangle& triangle, const ExactKernels& kernels, Progress& progress) const;

  const PatchMesh& mesh_;
  std::vector<Index> wanted_;
  FormFactorOptions options_;
  ExactScene scene_;
  std::size_t recheck_every_ = 1;
};

}  // namespace radiosity
