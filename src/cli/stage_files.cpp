// The input and the files that hold stages, for all subcommands.
#include <fmt/format.h>

#include <filesystem>

#include "base/figure_text.h"
#include "base/input_file.h"
#include "cli/commands.h"
#include "cli/light_cure.h"
#include "cli/matrix_commands.h"
#include "cli/signal_guard.h"
#include "cli/words.h"
#include "radiosity/matrix_files.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// Refuses every given option for reading scenes, even if its value is the default.
void refuseReadingOptions(const Request& request) {
  const std::string given = request.given.firstOf<SceneOptions>();
  if (given.empty() || !isResultsFile(request.input)) return;
  throw InputError(fmt::format(
      "{}: {} says how a scene file is read, and this is a results file; give the scene file",
      request.input, given));
}

/// Refuses a file with only form factors, which few subcommands take.
void requireScene(const Request& request) {
  if (!isMatrixInput(request.input)) return;
  requireFile(request.input);
  throw InputError(fmt::format(
      "{}: holds form factors alone, and {} needs a scene; solve, heat, info and compare take them",
      request.input, commandName(request.command)));
}

/// Warns if the output has results of another scene. Usually it has those of an earlier state of
/// this one.
void warnOfOtherScene(Session& session, const Scene& scene, const std::string& results_output) {
  namespace fs = std::filesystem;
  if (results_output.empty() || results_output == session.request.input) return;
  const std::optional<Scene> before = sceneInResults(results_output);
  if (!before || fs::path(before->file).filename() == fs::path(scene.file).filename()) return;
  if (before->vertices == scene.vertices && before->corners == scene.corners) return;
  const Note loud{Severity::loud,
                  fmt::format("{}: holds results of {}, which will be replaced by those of {}; "
                              "interrupt and write to another name to keep them",
                              results_output, before->file, scene.file)};
  session.report.notes({&loud, 1});
}

/// The folder for scratch memory: that of the output, which has room.
std::string scratchFolder(const Request& request, const std::string& results_output) {
  const std::string& output =
      !results_output.empty() || request.outputs.empty() ? results_output : request.outputs.front();
  const std::string folder = std::filesystem::path(output).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Refuses a solver that cannot use the form factors, before these are computed.
void requireSolver(const PipelineOptions& options) {
  const FormFactorOptions& factors = options.factors;
  if (options.solve.solver != Solver::cg || factors.givesSymmetric()) return;
  const MethodTraits& method = traitsOf(factors.method);
  throw InputError(fmt::format(
      "--solver cg: conjugate gradients need symmetric form factors, and those by the method {} "
      "are not; use --solver gmres or auto{}",
      method.word, method.uses("symmetrize") ? ", or merge the rows with --symmetrize" : ""));
}

/// Whether what is written is made of form factors one by one.
bool needsPairs(const Session& session) {
  const Request& request = session.request;
  // Tables of `factors` are for who wants single ones: rows that are cut have to be asked for.
  const bool lists = request.command == Command::factors &&
                     request.apply(FormFactorOptions()).method == FormFactorMethod::automatic;
  return lists || std::ranges::any_of(parseOutputs(request), [&](const Output& output) {
           const bool sums = !request.between.empty() && request.between != "patches";
           return output.format == Format::matrix_market && !sums;
         });
}

}  // namespace

Run::Run(Session& session, const std::string& results_output)
    : said(session.request, session.report, session.limit, !results_output.empty()),
      pipeline(session.progress, &said) {
  const Request& request = session.request;
  requireScene(request);
  refuseReadingOptions(request);
  pipeline.open(request.input, request.scene, results_output);
  warnOfOtherScene(session, pipeline.scene(), results_output);
  PipelineOptions& options = pipeline.options();
  options.mesh = request.apply(options.mesh);
  options.factors = request.apply(options.factors);
  options.factors.needs_pairs = needsPairs(session);
  options.solve = request.apply(options.solve);
  requireSolver(options);
  options.gather = request.apply(options.gather);
  options.elements = request.apply(options.elements);
  options.heat = request.apply(options.heat);
  options.journal = request.journal(results_output);
  options.factors.scratch_folder = scratchFolder(request, results_output);
  if (session.processes != nullptr) pipeline.share(*session.processes);
}

void requireLight(const Session& session, const Pipeline& pipeline) {
  pipeline.requireLight([&] { return lightCure(session.request, pipeline.scene()); });
}

OutputSet claimOutputs(const Session& session) {
  const Request& request = session.request;
  OutputSet files(parseOutputs(request));
  const bool keeps_stages = request.command == Command::factors ||
                            request.command == Command::solve ||
                            request.command == Command::gather || request.command == Command::heat;
  if (!keeps_stages || !files.all().empty()) return files;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(request.input, ignored) && isResultsFile(request.input)) {
    files.add({request.input, Format::results});
  } else {
    const char* kept_in = isMatrixInput(request.input) ? "FILE.csv" : "FILE.h5";
    session.report.line(
        "note", fmt::format("nothing will be written; add -o {} to keep the result", kept_in));
  }
  return files;
}

namespace {

std::string contents(const Results& results) {
  std::string list = "results: scene";
  forEachStage([&](const auto& stage) {
    if (results.*stage.value) list += std::string(", ") + stage.name;
  });
  return list;
}

/// Announces the size of the file. Throws RunError if the disk has no room for it.
void announceResults(Session& session, Pipeline& pipeline, const std::string& path) {
  pipeline.loadMatrix();
  const std::size_t bytes = estimateResultsBytes(pipeline.results());
  session.report.line("results", fmt::format("{}: {} to write", path, bytesText(bytes)));
  requireDiskSpace(path, bytes);
}

void reportResults(Session& session, const Pipeline& pipeline, const std::string& path) {
  std::error_code ignored;
  session.report.output(path, std::filesystem::file_size(path, ignored),
                        contents(pipeline.results()));
}

void writeResultsFile(Session& session, Pipeline& pipeline, OutputSet& files) {
  const std::string path = files.path(Format::results);
  pipeline.keepLaterStages();
  if (pipeline.isUpToDate(path)) {
    session.report.line("results", path + " is up to date");
    return;
  }
  if (pipeline.update(path)) {
    reportResults(session, pipeline, path);
    return;
  }
  announceResults(session, pipeline, path);
  files.write(Format::results, contents(pipeline.results()), [&](const std::string& temporary) {
    writeResults(temporary, pipeline.results(), session.progress);
  });
}

}  // namespace

void keepFactors(Session& session, Pipeline& pipeline, const OutputSet& files) {
  const std::string path = files.path(Format::results);
  if (path.empty() || !pipeline.factorsComputed()) return;
  announceResults(session, pipeline, path);
  pipeline.checkpoint(path);
  sayIfInterrupted(path + " keeps the form factors", path);
  session.report.line("kept", "form factors, in " + path);
}

namespace {

/// `kept`: the contents of the file, for the message of an interrupted run.
void saveNow(Session& session, Pipeline& pipeline, const std::string& path, const char* kept) {
  if (!pipeline.update(path)) {
    announceResults(session, pipeline, path);
    pipeline.save(path);
  }
  sayIfInterrupted(fmt::format("{} keeps {}", path, kept), path);
  reportResults(session, pipeline, path);
}

}  // namespace

void keepSolution(Session& session, Pipeline& pipeline, const OutputSet& files) {
  const std::string path = files.path(Format::results);
  if (path.empty() || pipeline.isUpToDate(path)) return;
  saveNow(session, pipeline, path, "the form factors and the solution");
}

void saveResults(Session& session, Pipeline& pipeline, const OutputSet& files) {
  const std::string path = files.path(Format::results);
  if (path.empty()) return;
  pipeline.keepLaterStages();
  if (pipeline.isUpToDate(path)) {
    session.report.line("results", path + " is up to date");
    return;
  }
  saveNow(session, pipeline, path, "the form factors");
}

void writeStages(Session& session, Pipeline& pipeline, OutputSet& files) {
  if (files.has(Format::results)) writeResultsFile(session, pipeline, files);
  if (!files.has(Format::matrix_market)) return;
  pipeline.loadMatrix();
  writeMatrix(session, factorsOfPatches(pipeline.mesh().mesh, pipeline.factors()), files);
}

void writeMatrix(Session& session, const NamedFactors& factors, OutputSet& files) {
  const ExchangeMatrix& matrix = *factors.matrix;
  // Two indices and 17 digits with sign, point and exponent: at most 40 characters an entry.
  const std::size_t bytes = 40 * matrix.nonZeros();
  const std::string path = files.path(Format::matrix_market);
  session.report.line("matrix", fmt::format("{}: at most {} to write", path, bytesText(bytes)));
  requireDiskSpace(path, bytes);
  files.write(Format::matrix_market, "form factors, MatrixMarket, numbered from 1",
              [&](const std::string& temporary) {
                writeMatrixMarket(temporary, factors, session.progress);
              });
}

int exitCode(Session& session, bool usable, const std::string& message) {
  if (usable) return 0;
  const Note unusable{Severity::loud, message};
  session.report.notes({&unusable, 1});
  return 1;
}

int judgeSolution(Session& session, Pipeline& pipeline) {
  const SolveSummary& summary = pipeline.solution().summary;
  if (summary.status == SolveStatus::no_light) {
    const Note dark{Severity::warning,
                    darknessText(session.request, pipeline.scene(), pipeline.bands())};
    session.report.notes({&dark, 1});
  }
  return exitCode(session, summary.usable(), summary.message);
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
