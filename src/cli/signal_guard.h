// Ctrl-C.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "cli/console_progress.h"
#include "cli/time_limit.h"

namespace radiosity::cli {

/// While it lives, SIGINT, SIGTERM and the end of the time limit cancel `progress`: the run ends at
/// its next step, cleanly.
/// Where no step ends in time, a thread of its own removes what is half-written, says so, and ends
/// the process: someone who waits is answered within half a second, whatever is being done. A third
/// signal ends the process at once. The same thread keeps the progress drawn. SIGPIPE is ignored: a
/// closed pipe loses lines, not the run.
class SignalGuard {
 public:
  explicit SignalGuard(ConsoleProgress& progress, const TimeLimit& limit = TimeLimit(kNoTimeLimit));
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

 private:
  void watch();

  ConsoleProgress& progress_;
  TimeLimit limit_;
  std::atomic<bool> over_{false};
  std::thread watcher_;
};

/// The message of a run that was interrupted, or out of time: it names what is on disk by then, if
/// anything.
std::string interruptedText();

/// A run that is interrupted from now on prints this text, as long as the file `path` is there.
void sayIfInterrupted(const std::string& text, const std::string& path);

}  // namespace radiosity::cli
