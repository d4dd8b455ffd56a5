// What the subcommands share: the files that hold stages.
#include <fmt/format.h>

#include <filesystem>

#include "cli/commands.h"
#include "cli/words.h"
#include "radiosity/results.h"

namespace radiosity::cli {

OutputSet claimOutputs(const Session& session) {
  const Request& request = session.request;
  OutputSet files(parseOutputs(request));
  const bool keeps_stages = request.command == Command::factors ||
                            request.command == Command::solve || request.command == Command::gather;
  if (!keeps_stages || !files.all().empty()) return files;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(request.input, ignored) && isResultsFile(request.input)) {
    files.add({request.input, Format::results});
  } else {
    session.report.line("note", "nothing will be written; add -o FILE.h5 to keep the result");
  }
  return files;
}

namespace {

std::string contents(const Results& results) {
  std::string list = "results: scene, mesh";
  if (results.factors) list += ", form factors";
  if (results.solution) list += ", solution";
  if (results.gathered) list += ", gathered light";
  return list;
}

void writeResultsFile(Session& session, Pipeline& pipeline, OutputSet& files) {
  const std::string path = files.path(Format::results);
  pipeline.keepLaterStages();
  if (!pipeline.changed() && pipeline.source() == path) {
    session.report.line("results", path + " is up to date");
    return;
  }
  pipeline.loadMatrix();
  const std::size_t bytes = estimateResultsBytes(pipeline.results());
  session.report.line("results", fmt::format("{}: {} to write", path, bytesText(bytes)));
  requireDiskSpace(path, bytes);
  files.write(Format::results, contents(pipeline.results()), [&](const std::string& temporary) {
    writeResults(temporary, pipeline.results(), session.progress);
  });
}

}  // namespace

void writeStages(Session& session, Pipeline& pipeline, OutputSet& files) {
  if (files.has(Format::results)) writeResultsFile(session, pipeline, files);
  if (!files.has(Format::matrix_market)) return;
  pipeline.loadMatrix();
  const ExchangeMatrix& matrix = pipeline.formFactors().matrix;
  // Two indices and 17 digits with sign, point and exponent: at most 40 characters an entry.
  const std::size_t bytes = 40 * matrix.nonZeros();
  const std::string path = files.path(Format::matrix_market);
  session.report.line("matrix", fmt::format("{}: at most {} to write", path, bytesText(bytes)));
  requireDiskSpace(path, bytes);
  files.write(Format::matrix_market, "form factors, MatrixMarket",
              [&](const std::string& temporary) {
                writeMatrixMarket(temporary, matrix, session.progress);
              });
}

int judgeSolution(Session& session, Pipeline& pipeline) {
  const SolveSummary& summary = pipeline.solved().summary;
  if (summary.usable()) {
    if (summary.status == SolveStatus::no_light) {
      const Note dark{Severity::warning,
                      "nothing emits light, so B = 0 everywhere; make something a lamp with "
                      "--set NAME.radiance=VALUE"};
      session.report.notes({&dark, 1});
    }
    return 0;
  }
  const Note unusable{Severity::loud, summary.message};
  session.report.notes({&unusable, 1});
  if (summary.status == SolveStatus::singular) {
    pipeline.results().solution.reset();
    pipeline.results().materials.reset();
    pipeline.results().solution_key.clear();
  }
  return 1;
}

void noteUnsaved(Session& session, const Pipeline& pipeline, const OutputSet& files) {
  const std::string& input = session.request.input;
  if (pipeline.fromResultsFile() && pipeline.changed() && !files.has(Format::results)) {
    session.report.line("note", fmt::format("{} is left as it is; add -o {} to keep what was "
                                            "computed",
                                            input, input));
  }
}

}  // namespace radiosity::cli
