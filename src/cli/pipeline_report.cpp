#include "cli/pipeline_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "base/figure_text.h"
#include "base/made.h"
#include "cli/outputs.h"
#include "cli/signal_guard.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

namespace {

/// For longer waits the report suggests options that shorten them.
constexpr double kLongWait = 60;

/// The options that shorten a wait, and the shorter time if it is known.
std::string cures(const FormFactorPlan& plan) {
  constexpr double kLoosest = 0.1;
  std::string text = "for less:";
  const double tolerance = plan.tolerance;
  const double looser = std::min(kLoosest, (plan.refining_order > 1 ? 3 : 10) * tolerance);
  if (looser > tolerance) {
    text += fmt::format(" --tolerance {} (about {}),", numberText(looser, 2),
                        durationText(plan.secondsIfLooser(looser / tolerance)));
  }
  text += " fewer --patches";
  if (traitsOf(plan.method).uses("resolution")) text += ", a lower --resolution";
  if (plan.other && plan.other->seconds < plan.seconds) {
    text += fmt::format(", --method {} (about {})", traitsOf(plan.other->method).word,
                        durationText(plan.other->seconds));
  }
  return text;
}

const char* wordOf(StageAction action) {
  switch (action) {
    case StageAction::reused:
      return "reused";
    case StageAction::computed:
      return "computed";
    case StageAction::recomputed:
      return "recomputed";
    case StageAction::kept:
      return "kept";
    case StageAction::dropped:
      return "dropped";
  }
  throw std::logic_error("an action without a word");
}

/// Whether a note on the scene only matters for light; heat has emissivities instead.
bool isAboutLight(const Note& note) {
  if (note.severity == Severity::loud) return false;
  const std::string_view words[] = {"reflectance", "emission", "radiance", "texture"};
  return std::any_of(std::begin(words), std::end(words), [&](std::string_view word) {
    return note.text.find(word) != std::string::npos;
  });
}

}  // namespace

void PipelineReport::opened(const Pipeline& pipeline) {
  requireNoFileOfScene(request_);
  summarizeScene(report_, pipeline.scene(), request_.input);
}

void PipelineReport::notes(const Pipeline& pipeline, std::span<const Note> notes) {
  // `info` prints the notes of a scene file at its end.
  if (request_.command == Command::info && !pipeline.fromResultsFile()) return;
  if (request_.command != Command::heat) return report_.notes(notes);
  std::vector<Note> not_of_light;
  std::copy_if(notes.begin(), notes.end(), std::back_inserter(not_of_light),
               [](const Note& note) { return !isAboutLight(note); });
  report_.notes(not_of_light);
}

void PipelineReport::notReused(const std::string& path, const std::string& why) {
  report_.line("note", fmt::format("nothing is reused from {}: {}", path, oneLine(why)));
}

/// Notes given options that apply to another method than the chosen one.
void PipelineReport::noteUnused(FormFactorMethod method) {
  FormFactorOptions options = request_.apply(FormFactorOptions());
  options.method = method;
  // Gathering uses hemicubes, too.
  const bool gathers = request_.command == Command::gather || request_.command == Command::compare;
  const std::vector<Option> of_gather =
      gathers ? optionLines(GatherOptions()) : std::vector<Option>();
  std::vector<std::string> unused;
  for (const Option& option : optionLines(options)) {
    const std::string name = option.line.optionName();
    if (option.line.used || option.text == option.line.off || !request_.given.has(name)) continue;
    const bool used = std::ranges::any_of(
        of_gather, [&](const Option& o) { return o.line.optionName() == name; });
    if (!used) unused.push_back(request_.given.spelled(name));
  }
  if (unused.empty()) return;
  const Note note{Severity::warning,
                  fmt::format("not used by the method {}: {}", nameOf(kMethodNames, method),
                              fmt::join(unused, ", "))};
  report_.notes({&note, 1});
}

void PipelineReport::planned(const Pipeline& pipeline, const FormFactorPlan& plan) {
  const FormFactorOptions& options = pipeline.options().factors;
  const std::size_t patches = made(pipeline.results().mesh).mesh.size();
  const MethodTraits& method = traitsOf(plan.method);
  // On disk every entry has a column number of 4 bytes. In memory a dense row has none, and a
  // symmetric matrix has half of the entries.
  const std::size_t value = options.storedPrecision() == Precision::double_precision ? 8 : 4;
  const std::size_t disk = plan.matrix_bytes * (method.symmetric ? 2 : 1) * (value + 4) / value;
  std::string what = plan.what;
  if (what.empty()) {
    what = fmt::format("{} between {}", method.word, plural(patches, "patch", "patches"));
  }
  if (plan.tolerance > 0) what += " to " + numberText(plan.tolerance, 2);
  report_.line(
      "form factors",
      fmt::format(
          "{}: about {}, memory about {}{}{}", what, durationText(plan.seconds),
          bytesText(plan.bytes),
          plan.scratch_bytes > 0 ? ", scratch file about " + bytesText(plan.scratch_bytes) : "",
          writes_results_ ? ", disk at most about " + bytesText(disk) : ""));
  if (!plan.reason.empty()) report_.line("", "because " + plan.reason);
  noteUnused(plan.method);
  if (options.onlyForSources() && method.uses("tolerance")) {
    report_.line("", "only as sources of the light that elements gather; --tolerance for more");
  }
  if (plan.seconds_to_tolerance) {
    const double tolerance = options.toleranceOf(plan.method);
    report_.line("", fmt::format("for --tolerance {}: about {}", numberText(tolerance),
                                 durationText(*plan.seconds_to_tolerance)));
  }
  const double left = limit_.left();
  if (plan.seconds > left) {
    throw RunError(
        fmt::format("form factors would take about {}, and --time-limit {} leaves {}; {}",
                    durationText(plan.seconds), durationText(limit_.seconds()),
                    durationText(std::max(0.0, left)), cures(plan)));
  }
  if (plan.seconds > kLongWait) report_.line("", cures(plan));
}

void PipelineReport::keepsRows(const Pipeline& /*pipeline*/, const std::string& path) {
  sayIfInterrupted(fmt::format("{} keeps the rows; the same command goes on from them", path),
                   path);
}

void PipelineReport::rows(const Pipeline& /*pipeline*/, const std::string& text) {
  report_.line("rows", text);
}

void PipelineReport::stage(const Pipeline& pipeline, const StageEvent& event) {
  const bool kept = event.action == StageAction::kept;
  forEachStage([&](const auto& stage) {
    if (stage.stage != event.stage) return;
    report_.stage(stage.group, stage.name, wordOf(event.action),
                  kept ? "still valid" : event.detail, event.seconds.value_or(-1));
  });
  if (kept || event.action == StageAction::dropped) return;
  summarize(pipeline, event);
  if (event.stage != Stage::form_factors || event.action != StageAction::reused) return;
  // Computed form factors were noted when they were planned.
  noteUnused(made(pipeline.results().factors).method);
}

void PipelineReport::summarize(const Pipeline& pipeline, const StageEvent& event) {
  const Results& results = pipeline.results();
  const PatchMesh& mesh = made(results.mesh).mesh;
  const PipelineOptions& options = pipeline.options();
  const auto detail = [&](Command own) {
    return request_.command == own ? Detail::full : Detail::brief;
  };
  // A reused mesh or form factors need no report if they are only an intermediate step.
  const auto stepDetail = [&](Command own) {
    const bool reused = event.action == StageAction::reused;
    return reused && request_.command != own ? Detail::none : detail(own);
  };
  switch (event.stage) {
    case Stage::mesh:
      return summarizeMesh(report_, made(results.mesh), stepDetail(Command::mesh));
    case Stage::form_factors:
      return summarizeFactors(report_, made(results.factors), mesh, stepDetail(Command::factors));
    case Stage::solution:
      return summarizeSolution(report_, made(results.solution), made(results.factors), mesh,
                               results.materials && arePhotometric(results.materials->lights),
                               options.solve, detail(Command::solve));
    case Stage::gather:
      return summarizeGathered(report_, made(results.gathered), mesh, options.gather,
                               detail(Command::gather));
    case Stage::heat:
      return summarizeHeat(report_, made(results.heat), made(results.factors),
                           heatBySurface(made(results.heat), mesh, made(results.factors)),
                           options.heat, detail(Command::heat));
    case Stage::basis:
      return summarizeBasis(report_, made(results.basis), detail(Command::solve));
    default:
      return;  // elements: outputs report them, since a picture may only have some
  }
}

}  // namespace radiosity::cli
