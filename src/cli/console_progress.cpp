#include "cli/console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "base/figure_text.h"
#include "base/process_memory.h"
#include "cli/words.h"

namespace radiosity::cli {

namespace {

constexpr double kBarInterval = 0.1;  // seconds between two pictures of the bar
constexpr double kShortStage = 0.5;   // a stage shorter than this leaves no line in a pipe
constexpr std::size_t kBarWidth = 24;

}  // namespace

ProgressStyle progressStyle(bool quiet) {
  if (quiet) return ProgressStyle::silent;
  const char* terminal = std::getenv("TERM");
  const bool dumb = terminal == nullptr || std::string(terminal) == "dumb";
  return isatty(STDERR_FILENO) != 0 && !dumb ? ProgressStyle::bar : ProgressStyle::lines;
}

double ConsoleProgress::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_.load()).count();
}

void ConsoleProgress::begin(const std::string& stage, std::size_t total, const std::string& steps,
                            std::size_t done) {
  const std::lock_guard lock(drawing_);
  stage_ = stage;
  steps_ = steps;
  total_ = total;
  done_before_ = done;
  done_ = done;
  start_ = Clock::now();
  next_draw_ = style_ == ProgressStyle::bar ? kBarInterval : line_times_.first;
  running_ = true;
}

void ConsoleProgress::advance(std::size_t steps) {
  done_ += steps;
  tick();
}

void ConsoleProgress::tick() {
  if (style_ == ProgressStyle::silent || elapsed() < next_draw_) return;
  // If another thread is drawing, this one continues with its work.
  const std::unique_lock lock(drawing_, std::try_to_lock);
  if (lock.owns_lock() && running_ && elapsed() >= next_draw_) draw();
}

void ConsoleProgress::draw() {
  const double seconds = elapsed();
  const std::size_t done = std::min<std::size_t>(done_, total_);
  const double share = total_ > 0 ? double(done) / double(total_) : 0;
  // Steps that were done before the stage began took none of its time.
  const double here = double(done) - double(done_before_);
  const std::string left =
      here > 0 ? durationText(seconds * double(total_ - done) / here) + " left" : "starting";
  std::string line;
  if (style_ == ProgressStyle::bar) {
    const auto full = std::size_t(share * double(kBarWidth));
    line = fmt::format("\r{:<14} [{}{}] {:3.0f}%  {}\033[K", stage_, std::string(full, '#'),
                       std::string(kBarWidth - full, '.'), 100 * share, left);
    drawn_ = true;
    next_draw_ = seconds + kBarInterval;
  } else {
    line = lineText(done, share, left);
    next_draw_ = seconds + line_times_.between;
  }
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

/// "form factors: 1,234 of 2,000 rows (62%), 34 s left, 312 MiB of memory".
std::string ConsoleProgress::lineText(std::size_t done, double share,
                                      const std::string& left) const {
  std::string line = stage_ + ": ";
  if (!steps_.empty()) {
    line += fmt::format("{} of {} {} (", countText(done), countText(total_), steps_);
  }
  line += fmt::format("{:.0f}%{}, {}", 100 * share, steps_.empty() ? "" : ")", left);
  const std::size_t memory = residentBytes();
  if (memory > 0) line += fmt::format(", {} of memory", bytesText(memory));
  return line + "\n";
}

void ConsoleProgress::end() {
  clear();
  if (style_ == ProgressStyle::lines && elapsed() >= kShortStage && !cancelled()) {
    std::fputs(fmt::format("{}: done in {}\n", stage_, durationText(elapsed())).c_str(), stderr);
  }
}

void ConsoleProgress::clear() {
  const std::lock_guard lock(drawing_);
  running_ = false;
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace radiosity::cli
