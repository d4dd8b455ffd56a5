// radiosity: parses the arguments, runs one subcommand, reports, and returns the exit code (0 done,
// 1 the run failed or did not converge, 2 bad input or arguments).
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <thread>

#include "base/atomic_file.h"
#include "base/processes.h"
#include "cli/commands.h"
#include "cli/console_progress.h"
#include "cli/signal_guard.h"
#include "cli/words.h"
#include "radiosity/spelling.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

int dispatch(Session& session) {
  switch (session.request.command) {
    case Command::info:
      return runInfo(session);
    case Command::mesh:
      return runMesh(session);
    case Command::factors:
      return runFactors(session);
    case Command::solve:
      return runSolve(session);
    case Command::gather:
      return runGather(session);
    case Command::heat:
      return runHeat(session);
    case Command::compare:
      return runCompare(session);
    case Command::render:
      return runRender(session);
    case Command::illuminance:
      return runIlluminance(session);
    case Command::view:
      break;
  }
  return runView(session);
}

int run(const Request& request, const TimeLimit& limit, ConsoleProgress& progress,
        Processes* processes) {
  // We claim the report and release it, so that an error is found before any work is done.
  if (!request.report.empty()) AtomicFile(request.report);
  setThreads(request.threads);
  Report report(request.quiet);
  report.fact("version", RADIOSITY_VERSION);
  report.fact("command", commandName(request.command));
  report.fact("input", request.input);
  report.fact("arguments", request.arguments);
  Session session{request, report, progress, limit, processes};
  const int code = dispatch(session);
  report.exitCode(code);
  if (!request.report.empty()) report.write(request.report);
  return code;
}

int fail(const std::string& message, int code) {
  std::fputs(fmt::format("radiosity: {}\n", oneLine(message)).c_str(), stderr);
  return code;
}

/// Opens the standard files that the caller closed: else the first output would take their numbers,
/// and lines meant for a person would go into it. Writing to a closed standard output still fails.
void openStandardFiles() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(number, F_GETFD) >= 0) continue;
    if (open("/dev/null", number == STDERR_FILENO ? O_WRONLY : O_RDONLY) != number) std::abort();
  }
}

/// The exit code of a run, or 1 if lines of its standard output were lost, as on a full disk. A
/// reader that closed its pipe wanted no more.
int judgeOutput(int code) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0) return code;
  return fail("standard output cannot be written; is its disk full?", code == 0 ? 1 : code);
}

/// Parses the arguments and runs the command; all errors end here.
int runProgram(int argc, char** argv, Processes* processes) {
  try {
    Request request;
    if (const std::optional<int> done = parseCommandLine(argc, argv, request)) return *done;
    ConsoleProgress progress(progressStyle(request.quiet));
    const TimeLimit limit(request.time_limit);
    const SignalGuard guard(progress, limit);
    try {
      return run(request, limit, progress, processes);
    } catch (...) {
      progress.clear();
      // A library that the signal stopped half-way may report another error.
      if (progress.cancelled()) return fail(interruptedText(), 1);
      throw;
    }
  } catch (const InputError& error) {
    return fail(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return fail("out of memory; use fewer --patches, or --memory-limit to be told before", 1);
  } catch (const std::exception& error) {
    return fail(error.what(), 1);
  }
}

/// Runs the command in process 0 of several; then all end.
int runFirst(int argc, char** argv, Processes& processes) {
  const int code = judgeOutput(runProgram(argc, argv, &processes));
  if (processes.halfDone()) processes.abort(code);
  SharedTask end = SharedTask::end;
  processes.broadcastValue(end);
  processes.finish();
  return code;
}

/// Serves process 0 in another process. Only process 0 reports errors of the command line and
/// prints.
int runOther(int argc, char** argv, Processes& processes) {
  try {
    Request request;
    if (std::freopen("/dev/null", "w", stdout) == nullptr) std::fclose(stdout);
    try {
      parseCommandLine(argc, argv, request);
    } catch (const InputError&) {
      return serveCommand({}, processes);
    }
    return serveCommand(request, processes);
  } catch (const std::exception& error) {
    // If all processes have this error, process 0 reports it and ends them, so we wait first.
    constexpr std::chrono::seconds kForFirst{1};
    std::this_thread::sleep_for(kForFirst);
    fail(fmt::format("process {} of {}: {}", processes.rank(), processes.size(), error.what()), 1);
    processes.abort(1);
  }
  return 1;
}

}  // namespace

}  // namespace radiosity::cli

int main(int argc, char** argv) {
  using namespace radiosity;
  using namespace radiosity::cli;
  setSpelling(spelledAsOption);
  openStandardFiles();
  ignoreSignalsOfWriting();
  if (!startedByMpi()) return judgeOutput(runProgram(argc, argv, nullptr));
  try {
    Processes& processes = joinProcesses();
    return processes.rank() == 0 ? runFirst(argc, argv, processes)
                                 : runOther(argc, argv, processes);
  } catch (const RunError& error) {
    return fail(error.what(), 1);
  }
}
