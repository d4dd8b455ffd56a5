#include "cli/commands.h"

namespace radiosity::cli {

int runFactors(Session& session) {
  OutputSet files = claimOutputs(session);
  Run run(session, files.path(Format::results));
  run.pipeline.factors();
  writeCells(session, run.pipeline, files);
  writeStages(session, run.pipeline, files);
  files.commit(session.report, session.progress);
  run.pipeline.discardKeptRows();
  return 0;
}

}  // namespace radiosity::cli
