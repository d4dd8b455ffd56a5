// The time that a run may take.
#pragma once

#include <chrono>
#include <optional>

namespace radiosity::cli {

/// From its making on; without a limit it never passes.
class TimeLimit {
 public:
  explicit TimeLimit(std::optional<double> seconds) : seconds_(seconds) {}

  const std::optional<double>& seconds() const { return seconds_; }
  bool passed() const { return seconds_ && elapsed() >= *seconds_; }
  /// Seconds that are left; empty without a limit.
  std::optional<double> left() const {
    if (!seconds_) return std::nullopt;
    return *seconds_ - elapsed();
  }

 private:
  using Clock = std::chrono::steady_clock;
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  std::optional<double> seconds_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace radiosity::cli
