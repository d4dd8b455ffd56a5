#include "cli/commands.h"
#include "cli/element_use.h"
#include "cli/light_mix.h"
#include "cli/lightmap.h"
#include "cli/matrix_commands.h"
#include "cli/picture.h"
#include "cli/summaries.h"

namespace radiosity::cli {

namespace {

/// Writes the lit mesh, or the mesh with a lightmap, with the exposure of a picture of the same
/// light.
void writeLit(Session& session, Pipeline& pipeline, const SurfaceLight& light, OutputSet& files) {
  const ExposedPicture shown = exposePicture(session, pipeline, light);
  const PatchMesh& mesh = pipeline.mesh().mesh;
  if (session.request.lightmap.empty()) {
    writeLitMesh(session.report, mesh, light, files, shown.ev, shown.picture.options.crease);
  } else {
    writeLightmap(session, pipeline.scene(), mesh, light, shown.ev, files);
  }
}

/// Writes the outputs of --mix; only the light of single lamps is solved for.
int writeMix(Session& session, Pipeline& pipeline, const MixedLight& mix, bool elements,
             OutputSet& files) {
  writeStages(session, pipeline, files);
  if (files.has(Format::glb)) {
    writeLit(session, pipeline, mixedSurfaces(session, pipeline, mix, elements), files);
  }
  writeLightTable(pipeline, mix.solution, files);
  writeCells(session, pipeline, files, &mix);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace

int runSolve(Session& session) {
  OutputSet files = claimOutputs(session);
  if (takesMatrixFile(session.request)) return solveMatrixFile(session, files);
  const ElementUse elements = elementUse(session.request, files);
  checkLightmap(session.request, elements, files);
  checkMix(session.request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireColours(pipeline, session.request, files);
  chooseSources(session.request, pipeline);
  pipeline.factors();
  keepFactors(session, pipeline, files);
  if (!session.request.basis.empty()) pipeline.basis();
  if (const std::optional<MixedLight> mix = mixOf(session, pipeline)) {
    return writeMix(session, pipeline, *mix, elements.shown, files);
  }
  const int code = judgeSolution(session, pipeline);
  const bool singular = pipeline.solution().summary.status == SolveStatus::singular;
  if (elements.all && !singular) {
    keepSolution(session, pipeline, files);
    summarizeElements(session.report, pipeline.elements(), pipeline.factors());
  }
  writeStages(session, pipeline, files);
  if (files.has(Format::glb) && !singular) {
    writeLit(session, pipeline, elements.shown ? pipeline.elementLight() : pipeline.solvedLight(),
             files);
  }
  if (!singular) writeLightTable(pipeline, pipeline.solution(), files);
  writeCells(session, pipeline, files);
  files.commit(session.report, session.progress);
  return code;
}

}  // namespace radiosity::cli
