#include "radiosity/heat.h"

#include <fmt/format.h>

#include <utility>

#include "cli/matrix_commands.h"
#include "cli/radiant.h"
#include "cli/stored_conditions.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

void writeTables(Pipeline& pipeline, OutputSet& files) {
  const HeatSolution& heat = pipeline.heat();
  const PatchMesh& mesh = pipeline.mesh().mesh;
  files.write(Format::surface_table, "heat exchange by surface", [&](const std::string& temporary) {
    writeHeatTable(temporary, heatBySurface(heat, mesh, pipeline.factors()));
  });
  files.write(Format::patch_table, "heat exchange by patch",
              [&](const std::string& temporary) { writeHeatPatches(temporary, heat, mesh); });
}

bool givesConditions(const Request& request) {
  return !request.thermal.empty() || !request.conditions.empty();
}

ConditionText givenConditions(const Request& request) {
  return readConditionText(request.thermal, request.conditions, request.groups);
}

/// The given conditions, or else those of the heat in the results file.
HeatConditions conditionsFor(Session& session, const Pipeline& pipeline) {
  const Request& request = session.request;
  std::optional<HeatConditions> kept;
  if (!givesConditions(request)) kept = storedConditions(session, pipeline);
  return kept ? *kept : readHeatConditions(pipeline.scene(), givenConditions(request));
}

/// Notes options that affect light but not heat; reflectances may count as emissivities.
void noteLightOptions(Session& session, bool materials_are_used) {
  const SceneOptions& scene = session.request.scene;
  std::vector<std::string> unused;
  if (!materials_are_used) {
    if (!scene.set.empty()) unused.emplace_back("--set");
    if (!scene.materials_file.empty()) unused.emplace_back("--materials");
  }
  for (const Light& light : scene.lights) {
    unused.push_back(light.option() + " (heat has --sky-temperature)");
  }
  for (const std::string& name : session.request.given.allOf<SceneOptions>()) {
    if (name != "--unit" && !materials_are_used) unused.push_back(name);
  }
  if (unused.empty()) return;
  const Note note{Severity::warning,
                  fmt::format("about light, not used by heat: {}", fmt::join(unused, ", "))};
  session.report.notes({&note, 1});
}

}  // namespace

std::optional<HeatConditions> storedConditions(Session& session, const Pipeline& pipeline) {
  const Request& request = session.request;
  const Keyed<HeatSolution>& stored = pipeline.stored().heat;
  if (!pipeline.fromResultsFile() || !stored || stored->conditions.empty()) return std::nullopt;
  session.report.line("conditions", "those in " + request.input);
  ConditionText text = stored->conditions;
  text.origin = request.input + ": /heat/condition_table";
  text.groups.insert(text.groups.begin(), request.groups.begin(), request.groups.end());
  return readHeatConditions(pipeline.scene(), text);
}

bool hasHeat(Session& session, Pipeline& pipeline) {
  std::optional<HeatConditions> conditions = storedConditions(session, pipeline);
  if (!conditions) return false;
  pipeline.options().heat_conditions = std::move(*conditions);
  return true;
}

void requireHeat(Session& session, Pipeline& pipeline) {
  if (hasHeat(session, pipeline)) return;
  throw InputError(fmt::format(
      "{}: has no heat to show; solve for it first: radiosity heat SCENE --thermal TABLE.csv "
      "-o HEAT.h5, and render HEAT.h5",
      session.request.input));
}

int runHeat(Session& session) {
  OutputSet files = claimOutputs(session);
  if (takesMatrixFile(session.request)) return heatMatrixFile(session, files);
  if (givesConditions(session.request)) givenConditions(session.request);  // errors, before a scene
  checkRadiant(session.request);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  // We check the conditions first, so that errors are found before form factors are computed.
  PipelineOptions& options = pipeline.options();
  options.heat_conditions = conditionsFor(session, pipeline);
  validate(options.heat_conditions, options.heat);
  session.report.notes(options.heat_conditions.notes);
  noteLightOptions(session, options.heat_conditions.from_materials);
  const std::vector<MeasuringPoints> sets =
      measuringPoints(session.request.points, pipeline.scene(), session.report);
  if (pipeline.factors().report.closed) requireWithin(sets, pipeline.mesh().mesh);
  keepFactors(session, pipeline, files);
  const HeatSummary& summary = pipeline.heat().summary;
  const int exit_code = exitCode(session, summary.usable(), summary.message);
  writeStages(session, pipeline, files);
  writeTables(pipeline, files);
  if (!sets.empty()) measureRadiant(session, pipeline, sets, files);
  writeCells(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return exit_code;
}

}  // namespace radiosity::cli
