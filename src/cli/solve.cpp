#include "cli/commands.h"
#include "cli/picture.h"

namespace radiosity::cli {

int runSolve(Session& session) {
  OutputSet files = claimOutputs(session);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireColours(pipeline, session.request, files);
  const FormFactors& factors = pipeline.factors();
  keepFactors(session, pipeline, files);
  const int code = judgeSolution(session, pipeline);
  const bool singular = pipeline.solution().summary.status == SolveStatus::singular;
  writeStages(session, pipeline, files);
  if (files.has(Format::glb) && !singular) {
    Picture picture = choosePicture(session.request, pipeline.scene());
    const PatchMesh& mesh = pipeline.mesh().mesh;
    const SurfaceLight light = pipeline.solvedLight();
    framePicture(picture, mesh, factors.report.closed, light.reflected);
    const Image radiance =
        renderRadiance(mesh, light, picture.camera, picture.options, session.progress);
    const double ev = exposureOf(session.request, radiance);
    writeLitMesh(mesh, light, files, ev, picture.options.crease);
  }
  files.commit(session.report, session.progress);
  return code;
}

}  // namespace radiosity::cli
