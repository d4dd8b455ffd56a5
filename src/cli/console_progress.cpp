#include "cli/console_progress.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "cli/words.h"

namespace radiosity::cli {

namespace {

constexpr double kBarInterval = 0.1;    // seconds between two pictures of the bar
constexpr double kLineInterval = 10.0;  // and between two lines in a pipe
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
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ConsoleProgress::begin(const std::string& stage, std::size_t total) {
  const std::lock_guard lock(drawing_);
  stage_ = stage;
  total_ = total;
  done_ = 0;
  start_ = Clock::now();
  next_draw_ = style_ == ProgressStyle::bar ? kBarInterval : kLineInterval;
}

void ConsoleProgress::advance(std::size_t steps) {
  done_ += steps;
  if (style_ == ProgressStyle::silent || elapsed() < next_draw_) return;
  // Whoever comes while another thread draws goes on with its work.
  const std::unique_lock lock(drawing_, std::try_to_lock);
  if (lock.owns_lock() && elapsed() >= next_draw_) draw();
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
  if (!drawn_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

namespace {

// What the handler may touch: lock-free atomics only.
std::atomic<Progress*> running{nullptr};
std::atomic<int> signals{0};

void onSignal(int /*signal*/) {
  if (Progress* progress = running.load()) progress->cancel();
  if (++signals >= 3) _exit(1);
}

}  // namespace

SignalGuard::SignalGuard(Progress& progress) {
  running = &progress;
  struct sigaction action {};
  action.sa_handler = onSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);  // a file over its limit fails to write and is reported
}

SignalGuard::~SignalGuard() {
  running = nullptr;
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace radiosity::cli
