#include "cli/commands.h"
#include "radiosity/results.h"

namespace radiosity::cli {

int runMesh(Session& session) {
  OutputSet files = claimOutputs(session);
  Run run(session, files.path(Format::results));
  const PatchMesh& mesh = run.pipeline.mesh().mesh;
  const auto write = [&](const std::string& temporary) { writeMesh(temporary, mesh); };
  files.write(Format::obj, "patches, one group a surface", write);
  files.write(Format::glb, "patches, not lit", write);
  writeCells(session, run.pipeline, files);
  writeStages(session, run.pipeline, files);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace radiosity::cli
