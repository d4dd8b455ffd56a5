#include "cli/commands.h"
#include "radiosity/results.h"

namespace radiosity::cli {

int runMesh(Session& session) {
  OutputSet files = claimOutputs(session);
  Pipeline pipeline(session.request, session.report, session.progress);
  pipeline.open(files.path(Format::results));
  pipeline.mesh();
  const auto write = [&](const std::string& temporary) {
    writeMesh(temporary, pipeline.patches());
  };
  files.write(Format::obj, "patches, one group a surface", write);
  files.write(Format::glb, "patches, not lit", write);
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace radiosity::cli
