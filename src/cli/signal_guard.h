// Handles Ctrl-C and the time limit.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "cli/console_progress.h"
#include "cli/time_limit.h"

namespace radiosity::cli {

/// While it lives, SIGINT, SIGTERM and the end of the time limit cancel `progress`: the run ends
/// cleanly at its next step. If no step ends in time, a separate thread removes half-written files,
/// prints a message, and ends the process, so that the user always gets an answer within half a
/// second. A third signal ends the process at once. The same thread also draws the progress.
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

/// From now on a closed pipe loses lines but does not end the run, and a write over the limit of
/// file sizes fails and is reported.
void ignoreSignalsOfWriting();

/// The message of a run that was interrupted or ran out of time: it names the stages on disk, if
/// there are any.
std::string interruptedText();

/// Sets the text that an interrupted run prints from now on, as long as the file `path` exists.
void sayIfInterrupted(const std::string& text, const std::string& path);

}  // namespace radiosity::cli
