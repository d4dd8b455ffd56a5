#include "cli/commands.h"

namespace radiosity::cli {

int runFactors(Session& session) {
  OutputSet files = claimOutputs(session);
  Pipeline pipeline(session.request, session.report, session.progress);
  pipeline.open(files.path(Format::results));
  pipeline.mesh();
  pipeline.factors();
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace radiosity::cli
