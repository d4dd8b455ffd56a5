// Work that is given up when it takes too long.
#pragma once

#include <chrono>

#include "radiosity/base.h"

namespace radiosity {

/// Shows its stages by another progress, and is cancelled with it, or by itself after so many
/// seconds by the clock. It looks at the clock at every step.
class TimedProgress : public Progress {
 public:
  TimedProgress(Progress& outer, double seconds)
      : outer_(outer), end_(Clock::now() + std::chrono::duration<double>(seconds)) {}

  void begin(const std::string& stage, std::size_t total, const std::string& steps = {},
             std::size_t done = 0) override {
    is_open_ = true;
    outer_.begin(stage, total, steps, done);
  }
  void advance(std::size_t steps = 1) override {
    outer_.advance(steps);
    if (outer_.cancelled() || Clock::now() > end_) cancel();
  }
  void end() override {
    is_open_ = false;
    outer_.end();
  }
  /// After Cancelled: ends the stage that was given up. Throws Cancelled where the other progress
  /// was what was cancelled.
  void giveUp() {
    if (is_open_) end();
    outer_.check();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Progress& outer_;
  std::chrono::time_point<Clock, std::chrono::duration<double>> end_;
  bool is_open_ = false;
};

}  // namespace radiosity
