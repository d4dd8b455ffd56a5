// Progress of work that is given up when it takes too long.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "base/processor_clock.h"
#include "radiosity/base.h"

namespace radiosity {

/// Passes its stages on to another progress. It is cancelled when the other is, or after `seconds`
/// of `clock`.
class TimedProgress : public Progress {
 public:
  TimedProgress(Progress& outer, double seconds, double (*clock)() = clockSeconds)
      : outer_(outer), watch_([this, clock, end = clock() + seconds](const std::stop_token& over) {
          watch(over, clock, end);
        }) {}

  void begin(const std::string& stage, std::size_t total, const std::string& steps = {},
             std::size_t done = 0) override {
    is_open_ = true;
    outer_.begin(stage, total, steps, done);
  }
  void advance(std::size_t steps = 1) override { outer_.advance(steps); }
  void end() override {
    is_open_ = false;
    outer_.end();
  }
  /// Ends the stage that was given up; call it after Cancelled. Throws Cancelled if the other
  /// progress was cancelled.
  void giveUp() {
    if (is_open_) end();
    outer_.check();
  }

 private:
  static constexpr std::chrono::milliseconds kBetweenLooks{10};

  void watch(const std::stop_token& over, double (*clock)(), double end) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any waiting;
    while (!outer_.cancelled() && clock() < end) {
      waiting.wait_for(lock, over, kBetweenLooks, [] { return false; });
      if (over.stop_requested()) return;
    }
    cancel();
  }

  Progress& outer_;
  bool is_open_ = false;
  std::jthread watch_;  // the last member, so that it ends before the others
};

}  // namespace radiosity
