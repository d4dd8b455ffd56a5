#include "cli/commands.h"
#include "cli/element_use.h"
#include "cli/lightmap.h"
#include "cli/matrix_commands.h"
#include "cli/picture.h"
#include "cli/summaries.h"

namespace radiosity::cli {

namespace {

/// Writes the lit mesh, or the one with a lightmap, exposed as the picture of the same light is.
void writeLit(Session& session, Pipeline& pipeline, bool elements, OutputSet& files) {
  const SurfaceLight light = elements ? pipeline.elementLight() : pipeline.solvedLight();
  const ExposedPicture shown = exposePicture(session, pipeline, light);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  if (session.request.lightmap.empty()) {
    writeLitMesh(session.report, mesh, light, files, shown.ev, shown.picture.options.crease);
  } else {
    writeLightmap(session, pipeline.scene(), mesh, light, shown.ev, files);
  }
}

}  // namespace

int runSolve(Session& session) {
  OutputSet files = claimOutputs(session);
  if (solvesMatrixFile(session.request)) return solveMatrixFile(session, files);
  const ElementUse elements = elementUse(session.request, files);
  checkLightmap(session.request, elements, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireColours(pipeline, session.request, files);
  pipeline.factors();
  keepFactors(session, pipeline, files);
  const int code = judgeSolution(session, pipeline);
  const bool singular = pipeline.solution().summary.status == SolveStatus::singular;
  if (elements.all && !singular) {
    keepSolution(session, pipeline, files);
    summarizeElements(session.report, pipeline.elements(), pipeline.factors());
  }
  writeStages(session, pipeline, files);
  if (files.has(Format::glb) && !singular) writeLit(session, pipeline, elements.shown, files);
  if (!singular) writeLightTable(pipeline, files);
  writeCells(session, pipeline, files);
  files.commit(session.report, session.progress);
  return code;
}

}  // namespace radiosity::cli
