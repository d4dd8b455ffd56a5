#include "radiosity/heat.h"

#include "base/made.h"
#include "cli/commands.h"
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

}  // namespace

int runHeat(Session& session) {
  OutputSet files = claimOutputs(session);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  // Before form factors are computed: what is wrong with the conditions is soon found.
  PipelineOptions& options = pipeline.options();
  options.heat_conditions =
      readHeatConditions(pipeline.scene(), session.request.thermal, session.request.conditions);
  validate(options.heat_conditions, options.heat);
  pipeline.factors();
  keepFactors(session, pipeline, files);
  const HeatSummary& summary = pipeline.heat().summary;
  if (!summary.usable()) {
    const Note unusable{Severity::loud, summary.message};
    session.report.notes({&unusable, 1});
  }
  writeStages(session, pipeline, files);
  writeTables(pipeline, files);
  writeCells(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return summary.usable() ? 0 : 1;
}

}  // namespace radiosity::cli
