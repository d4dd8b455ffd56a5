// Error against time: every method on every scene, measured in one run.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench_scenes.h"
#include "clocks.h"
#include "methods.h"
#include "truth_rows.h"

namespace radiosity::bench {

/// The error figures of a method beside the true errors.
struct OwnEstimate {
  double matrix = 0;        ///< its estimate of relL2(F)
  double rows_covered = 0;  ///< share of rows whose true error is below their figure
  double median_ratio = 0;  ///< median over rows of figure / true error
};

/// One method with one setting on one scene.
struct Measurement {
  std::string method;
  std::string setting;
  double value = 0;
  Seconds seconds;  ///< of the form-factor stage alone, one thread, no files; the least of `runs`
  int runs = 0;
  MatrixError factors;
  /// Area-weighted relL2 of the solved B over all bands against the reference; empty for the
  /// reference itself.
  std::optional<double> radiosity;
  std::size_t bytes = 0;         ///< of the matrix
  double largest_row_error = 0;  ///< max |fronts + backs + sky - 1|
  /// The exact method's own estimate; empty for the others.
  std::optional<OwnEstimate> own;
  ExactReport exact;
};

struct SceneCurves {
  std::string scene;
  std::size_t patches = 0;
  std::size_t polygons = 0;
  std::size_t truth_rows = 0;
  std::string radiosity_reference;  ///< what B is compared with
  std::vector<Measurement> measurements;
  /// Tolerances that the exact method was not run at: a looser one took more than kMostSeconds.
  std::vector<double> left_out;
};

/// The exact method gets no tighter once a run took longer, in processor time.
inline constexpr double kMostSeconds = 60;

/// Verifies truth, then runs the methods one after the other, printing a line each. B is compared
/// with that of truth where all rows are known, else with that of the tightest exact setting. Empty
/// where verification failed: nothing was timed.
std::optional<SceneCurves> errorCurves(const BenchScene& scene, const TruthRows& truth,
                                       double truth_accuracy, bool quick);

}  // namespace radiosity::bench
