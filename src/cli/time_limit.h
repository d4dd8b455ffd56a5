// The time that a run may take.
#pragma once

#include <chrono>
#include <limits>

namespace radiosity::cli {

/// The time limit, in seconds, of a run without one.
inline constexpr double kNoTimeLimit = std::numeric_limits<double>::infinity();

/// Measures the time since its construction.
class TimeLimit {
 public:
  explicit TimeLimit(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  double left() const {
    return seconds_ - std::chrono::duration<double>(Clock::now() - start_).count();
  }
  bool passed() const { return left() <= 0; }

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace radiosity::cli
