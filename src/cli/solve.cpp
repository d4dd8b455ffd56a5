#include "radiosity/solve.h"

#include "cli/commands.h"
#include "cli/picture.h"

namespace radiosity::cli {

int runSolve(Session& session) {
  OutputSet files = claimOutputs(session);
  Pipeline pipeline(session.request, session.report, session.progress);
  pipeline.open(files.path(Format::results));
  requireColours(pipeline, session.request, files);
  pipeline.mesh();
  pipeline.factors();
  keepFactors(session, pipeline, files);
  pipeline.solution();
  const int code = judgeSolution(session, pipeline);
  writeStages(session, pipeline, files);
  if (files.has(Format::glb) && pipeline.results().solution) {
    Picture picture = choosePicture(session.request, pipeline.scene());
    const Light light = solvedLight(pipeline);
    framePicture(picture, pipeline.patches(), pipeline.formFactors().report.closed,
                 light.reflected);
    const Image radiance = radiancePicture(picture, pipeline.patches(), light, session.progress);
    const double ev = exposureOf(session.request, radiance);
    writeLitMesh(pipeline.patches(), light, files, ev, picture.options.crease);
  }
  files.commit(session.report, session.progress);
  return code;
}

}  // namespace radiosity::cli
