// Summary of the curves: speed-up, growth, and the gain of a second core.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "error_curves.h"

namespace radiosity::bench {

/// error = factor * seconds^slope: the least-squares line through a curve's points in logarithms.
struct PowerLaw {
  double factor = 0;
  double slope = 0;
  double secondsAt(double error) const;
};

/// The exact method against the ray-cast curve at one error.
struct RayComparison {
  std::string scene;
  std::size_t patches = 0;
  std::string curve;           ///< kRays
  double error = 0;            ///< relL2(F)
  double exact_seconds = 0;    ///< of the cheapest setting measured that stays below the error
  double exact_tolerance = 0;  ///< that setting
  double exact_error = 0;      ///< what it reached
  PowerLaw rays;
  double ray_seconds = 0;     ///< by the curve's own law
  bool extrapolated = false;  ///< beyond the curve's dearest point
  double ratio() const { return ray_seconds / exact_seconds; }
};

/// The cost of the exact method at its default tolerance between two sizes of one scene.
struct Growth {
  std::size_t from = 0;
  std::size_t to = 0;
  double from_seconds = 0;
  double to_seconds = 0;
  double exponent = 0;  ///< seconds grow as N^exponent
};

/// Wall-clock time of the exact method on one thread and on two, in turn.
struct TwoCores {
  std::size_t patches = 0;
  double one = 0;
  double two = 0;
  /// Processor time over wall time of the two-thread run: below 2 is idling or being kept waiting
  /// by other jobs.
  double busy = 0;
};

/// The program itself on the cluttered scene, with writing.
struct WholeRun {
  std::size_t patches = 0;
  double wall = 0;
  double processor = 0;
  double peak_mebibytes = 0;
  std::size_t file_bytes = 0;
  int exit_code = 0;
};

struct Summary {
  std::vector<RayComparison> comparisons;
  std::optional<Growth> growth;
  std::optional<TwoCores> two_cores;
  std::optional<WholeRun> whole_run;
};

/// At relL2 1e-2 and 1e-3, where the exact method gets there, with either curve.
std::vector<RayComparison> compareWithRays(const SceneCurves& curves);

/// Between the Cornell boxes of about 1,000 and 20,000 patches, where both were measured.
std::optional<Growth> growth(const std::vector<SceneCurves>& curves);

TwoCores measureTwoCores(const PatchMesh& mesh);

/// `folder`: where the results file goes; it is removed again.
WholeRun measureWholeRun(const std::string& folder);

}  // namespace radiosity::bench
