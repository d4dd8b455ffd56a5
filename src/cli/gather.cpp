#include "cli/commands.h"
#include "cli/light_cure.h"
#include "cli/picture.h"

namespace radiosity::cli {

namespace {

/// The exit code: 1 if energy does not balance or the default limit of passes came first; 0
/// otherwise.
int judgeGathered(Session& session, const Pipeline& pipeline, const GatherSummary& summary) {
  if (!summary.usable()) return exitCode(session, false, summary.message);
  if (summary.status == GatherStatus::converged) return 0;
  const bool asked = summary.passes.size() != std::size_t(GatherOptions().passes);
  if (summary.status == GatherStatus::pass_limit && (asked || session.request.given.has("passes")))
    return 0;
  const bool dark = summary.status == GatherStatus::no_light;
  const Note note{dark ? Severity::warning : Severity::loud,
                  dark ? darknessText(session.request, pipeline.scene(), pipeline.bands())
                       : summary.message + "; allow more --passes"};
  session.report.notes({&note, 1});
  return dark ? 0 : 1;
}

}  // namespace

int runGather(Session& session) {
  OutputSet files = claimOutputs(session);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  requireColours(pipeline, session.request, files);
  Picture picture = choosePicture(session.request, pipeline.scene());
  const GatherSummary& summary = pipeline.gathered().summary;
  const int code = judgeGathered(session, pipeline, summary);
  if (hasPicture(files) || files.has(Format::glb)) {
    const PatchMesh& mesh = pipeline.mesh().mesh;
    const SurfaceLight light = pipeline.gatheredLight();
    framePicture(picture, mesh, summary.closed, light.reflected);
    reportPicture(session.report, picture);
    const Image radiance =
        renderRadiance(mesh, light, picture.camera, picture.options, session.progress);
    writeLight(session, mesh, light, radiance, picture, files);
  }
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
