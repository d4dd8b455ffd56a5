// Progress on standard error: a bar with the time left on a terminal, quiet lines in a pipe.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "radiosity/base.h"

namespace radiosity::cli {

enum class ProgressStyle { silent, lines, bar };

/// The style that fits standard error; silent where `quiet`.
ProgressStyle progressStyle(bool quiet);

class ConsoleProgress : public Progress {
 public:
  explicit ConsoleProgress(ProgressStyle style) : style_(style) {}
  ~ConsoleProgress() override { clear(); }
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void begin(const std::string& stage, std::size_t total) override;
  void advance(std::size_t steps = 1) override;
  void end() override;
  /// Draws anew where that is due, also where a step takes long: from a thread of its own.
  void tick();
  /// Takes the bar off the terminal, so that something else can be written there. The stage is
  /// over.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  double elapsed() const;
  void draw();

  ProgressStyle style_;
  std::string stage_;
  bool running_ = false;  ///< a stage is
  std::size_t total_ = 0;
  std::atomic<std::size_t> done_{0};
  std::atomic<Clock::time_point> start_{};
  std::atomic<double> next_draw_{0};  ///< seconds after start_
  std::mutex drawing_;
  bool drawn_ = false;
};

}  // namespace radiosity::cli
