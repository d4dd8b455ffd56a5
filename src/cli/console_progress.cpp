#include "cli/console_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cli/words.h"

namespace radiosity::cli {

namespace {

constexpr double kBarInterval = 0.1;    // seconds between two pictures of the bar
constexpr double kFirstLine = 2.0;      // before the first line of a stage in a pipe
constexpr double kLineInterval = 10.0;  // and between two of them
constexpr double kShortStage = 0.5;     // a stage shorter than this leaves no line in a pipe
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

void ConsoleProgress::begin(const std::string& stage, std::size_t total) {
  const std::lock_guard lock(drawing_);
  stage_ = stage;
  total_ = total;
  done_ = 0;
  start_ = Clock::now();
  next_draw_ = style_ == ProgressStyle::bar ? kBarInterval : kFirstLine;
  running_ = true;
}

void ConsoleProgress::advance(std::size_t steps) {
  done_ += steps;
  tick();
}

void ConsoleProgress::tick() {
  if (style_ == ProgressStyle::silent || elapsed() < next_draw_) return;
  // While one thread draws, the others go on with their work.
  const std::unique_lock lock(drawing_, std::try_to_lock);
  if (lock.owns_lock() && running_ && elapsed() >= next_draw_) draw();
}

void ConsoleProgress::draw() {
  const double seconds = elapsed();
  const double share = total_ > 0 ? std::min(1.0, double(done_) / double(total_)) : 0;
  const std::string left =
      share > 0 ? durationText(seconds * (1 - share) / share) + " left" : "starting";
  std::string line;
  if (style_ == ProgressStyle::bar) {
    const auto full = std::size_t(share * double(kBarWidth));
    line = fmt::format("\r{:<14} [{}{}] {:3.0f}%  {}\033[K", stage_, std::string(full, '#'),
                       std::string(kBarWidth - full, '.'), 100 * share, left);
    drawn_ = true;
    next_draw_ = seconds + kBarInterval;
  } else {
    line = fmt::format("{}: {:.0f}%, {}\n", stage_, 100 * share, left);
    next_draw_ = seconds + kLineInterval;
  }
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
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
