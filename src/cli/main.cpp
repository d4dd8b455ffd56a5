// radiosity: arguments -> one subcommand -> report -> exit code (0 done, 1 the run failed or did
// not converge, 2 bad input or arguments).
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/console_progress.h"
#include "cli/signal_guard.h"
#include "cli/words.h"
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
    case Command::view:
      break;
  }
  return runView(session);
}

int run(const Request& request, const TimeLimit& limit, ConsoleProgress& progress) {
  // Claimed and let go: a report that cannot be written is found before the work is done.
  if (!request.report.empty()) AtomicFile(request.report);
  setThreads(request.threads);
  Report report(request.quiet);
  report.fact("version", RADIOSITY_VERSION);
  report.fact("command", commandName(request.command));
  report.fact("input", request.input);
  report.fact("arguments", request.arguments);
  Session session{request, report, progress, limit};
  const int code = dispatch(session);
  report.exitCode(code);
  if (!request.report.empty()) report.write(request.report);
  return code;
}

int fail(const std::string& message, int code) {
  std::fputs(fmt::format("radiosity: {}\n", oneLine(message)).c_str(), stderr);
  return code;
}

}  // namespace

}  // namespace radiosity::cli

int main(int argc, char** argv) {
  using namespace radiosity;
  using namespace radiosity::cli;
  try {
    Request request;
    if (const std::optional<int> done = parseCommandLine(argc, argv, request)) return *done;
    ConsoleProgress progress(progressStyle(request.quiet));
    const TimeLimit limit(request.time_limit);
    const SignalGuard guard(progress, limit);
    try {
      return run(request, limit, progress);
    } catch (...) {
      progress.clear();
      // A library that stopped half-way because of the signal may report something else.
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
