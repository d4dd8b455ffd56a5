// Progress of an iteration whose residual falls towards a goal.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "radiosity/base.h"

namespace radiosity {

/// The residual falls about as fast from each power of ten to the next, so progress is measured by
/// its logarithm.
class ResidualProgress {
 public:
  ResidualProgress(Progress& progress, const std::string& stage, double start, double goal)
      : progress_(progress), start_(start), powers_(std::log(start / goal)) {
    progress_.begin(stage, kSteps);
  }

  /// Throws Cancelled.
  void at(double residual) {
    progress_.check();
    if (!(powers_ > 0 && residual > 0)) return;
    const double share = std::clamp(std::log(start_ / residual) / powers_, 0.0, 1.0);
    const auto steps = std::size_t(share * double(kSteps));
    advanceTo(steps);
  }
  void end() {
    advanceTo(kSteps);
    progress_.end();
  }

 private:
  void advanceTo(std::size_t steps) {
    for (; done_ < steps; ++done_) progress_.advance();
  }

  static constexpr std::size_t kSteps = 100;

  Progress& progress_;
  double start_;
  double powers_;
  std::size_t done_ = 0;
};

}  // namespace radiosity
