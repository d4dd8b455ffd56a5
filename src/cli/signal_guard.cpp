#include "cli/signal_guard.h"

#include <fmt/format.h>
#include <semaphore.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <optional>

#include "base/atomic_file.h"
#include "cli/words.h"

namespace radiosity::cli {

namespace {

using Clock = std::chrono::steady_clock;

constexpr long kTick = 100'000'000;  // nanoseconds between two checks
/// Time that a run may take from the signal to its end; with a tick, below half a second.
constexpr std::chrono::milliseconds kGrace{250};

// The handler may only use these: lock-free atomics, and a semaphore to post.
std::atomic<Progress*> running{nullptr};
std::atomic<int> signals{0};
sem_t wake;

void onSignal(int /*signal*/) {
  if (Progress* progress = running.load()) {
    progress->cancel();
    sem_post(&wake);
  }
  if (++signals >= 3) _exit(1);
}

void waitForATick() {
  timespec until{};
  clock_gettime(CLOCK_REALTIME, &until);
  until.tv_nsec += kTick;
  if (until.tv_nsec >= 1'000'000'000) {
    until.tv_nsec -= 1'000'000'000;
    ++until.tv_sec;
  }
  sem_timedwait(&wake, &until);
}

/// A text about the stages on disk; the watching thread reads it.
struct Kept {
  std::mutex mutex;
  std::string text;
  std::string path;  ///< of the file that the text is about
  std::string reason = "interrupted";
};
Kept& kept() {
  static Kept it;
  return it;
}

void sayOutOfTime(double seconds) {
  const std::lock_guard lock(kept().mutex);
  kept().reason = fmt::format("stopped after {}, --time-limit", durationText(seconds));
}

/// Ends the process of a run that does not end by itself.
[[noreturn]] void endProcess(ConsoleProgress& progress) {
  progress.clear();
  const std::string text = interruptedText();
  const auto lock = discardTemporaries();
  std::fputs(fmt::format("radiosity: {}\n", text).c_str(), stderr);
  std::fflush(stderr);
  _exit(1);
}

}  // namespace

void sayIfInterrupted(const std::string& text, const std::string& path) {
  const std::lock_guard lock(kept().mutex);
  kept().text = text;
  kept().path = path;
}

std::string interruptedText() {
  const std::lock_guard lock(kept().mutex);
  if (!kept().text.empty() && access(kept().path.c_str(), F_OK) == 0) {
    return kept().reason + "; " + kept().text;
  }
  return kept().reason +
         (committedFiles() == 0 ? "; nothing was written" : "; what was written is whole");
}

void ignoreSignalsOfWriting() {
  struct sigaction action {};
  action.sa_handler = SIG_IGN;
  sigemptyset(&action.sa_mask);
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

SignalGuard::SignalGuard(ConsoleProgress& progress, const TimeLimit& limit)
    : progress_(progress), limit_(limit) {
  sem_init(&wake, 0, 0);
  running = &progress;
  watcher_ = std::thread([this] { watch(); });
  struct sigaction action {};
  action.sa_handler = onSignal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

SignalGuard::~SignalGuard() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  running = nullptr;
  over_ = true;
  sem_post(&wake);
  watcher_.join();
}

void SignalGuard::watch() {
  std::optional<Clock::time_point> interrupted;
  while (!over_) {
    waitForATick();
    if (!progress_.cancelled() && !limit_.passed()) {
      progress_.tick();
      continue;
    }
    if (!progress_.cancelled()) {
      sayOutOfTime(limit_.seconds());
      progress_.cancel();
    }
    if (!interrupted) interrupted = Clock::now();
    if (!over_ && Clock::now() - *interrupted >= kGrace) endProcess(progress_);
  }
}

}  // namespace radiosity::cli
