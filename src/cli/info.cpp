#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/summaries.h"

namespace radiosity::cli {

namespace {

/// The stages a results file holds, and the options that made them.
void describeStages(Session& session, const Results& stored) {
  Report& report = session.report;
  report.section("file", "Stages in the file");
  report.text("version", "written by", "radiosity " + stored.version);
  if (stored.mesh) report.text("mesh_key", "mesh", stored.mesh_key);
  if (stored.factors) report.text("factors_key", "form factors", stored.factors_key);
  if (stored.solution) report.text("solution_key", "solution", stored.solution_key);
  if (stored.gathered) report.text("gather_key", "gather", stored.gather_key);
  if (stored.mesh) summarizeMesh(report, *stored.mesh, Detail::brief);
  if (stored.factors) {
    summarizeFactors(report, *stored.factors, made(stored.mesh).mesh, Detail::brief);
  }
  if (stored.solution) {
    summarizeSolution(report, *stored.solution, made(stored.factors), made(stored.mesh).mesh,
                      solveOptionsOf(StageKey(stored.solution_key)), Detail::brief);
  }
  if (stored.gathered) {
    summarizeGathered(report, *stored.gathered, made(stored.mesh).mesh,
                      gatherOptionsOf(StageKey(stored.gather_key)), Detail::brief);
  }
}

}  // namespace

int runInfo(Session& session) {
  Pipeline pipeline(session.request, session.report, session.progress);
  pipeline.open({});
  describeScene(session.report, pipeline.scene());
  if (pipeline.fromResultsFile()) describeStages(session, pipeline.stored());
  return 0;
}

}  // namespace radiosity::cli
