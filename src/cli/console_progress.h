// Progress on standard error: on a terminal a bar with the time left, in a pipe a line a minute.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

#include "radiosity/base.h"

namespace radiosity::cli {

enum class ProgressStyle { silent, lines, bar };

/// The style that suits standard error; silent if `quiet`.
ProgressStyle progressStyle(bool quiet);

class ConsoleProgress : public Progress {
 public:
  /// Seconds of a stage before its first line in a pipe, and between two.
  struct LineTimes {
    double first = 10;
    double between = 60;
  };
  explicit ConsoleProgress(ProgressStyle style, LineTimes line_times)
      : style_(style), line_times_(line_times) {}
  explicit ConsoleProgress(ProgressStyle style) : ConsoleProgress(style, LineTimes()) {}
  ~ConsoleProgress() override { clear(); }
  ConsoleProgress(const ConsoleProgress&) = delete;
  ConsoleProgress& operator=(const ConsoleProgress&) = delete;

  void begin(const std::string& stage, std::size_t total, const std::string& steps = {},
             std::size_t done = 0) override;
  void advance(std::size_t steps = 1) override;
  void end() override;
  /// Draws again if it is time. A separate thread calls it, also while a step takes long.
  void tick();
  /// Removes the bar from the terminal and ends the stage, so that other text can be written.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  double elapsed() const;
  void draw();
  std::string lineText(std::size_t done, double share, const std::string& left) const;

  ProgressStyle style_;
  LineTimes line_times_;
  std::string stage_;
  std::string steps_;     ///< the name of the steps
  bool running_ = false;  ///< a stage is running
  std::size_t total_ = 0;
  std::size_t done_before_ = 0;  ///< when the stage began
  std::atomic<std::size_t> done_{0};
  std::atomic<Clock::time_point> start_{};
  std::atomic<double> next_draw_{0};  ///< seconds after start_
  std::mutex drawing_;
  bool drawn_ = false;
};

}  // namespace radiosity::cli
