#include "cli/commands.h"
#include "cli/tables.h"

namespace radiosity::cli {

int runFactors(Session& session) {
  OutputSet files = claimOutputs(session);
  checkTableOptions(session.request, files);
  Run run(session, files.path(Format::results));
  checkGroups(session.request, run.pipeline.scene());
  run.pipeline.factors();
  writeTables(session, run.pipeline, files);
  writeCells(session, run.pipeline, files);
  writeStages(session, run.pipeline, files);
  files.commit(session.report, session.progress);
  run.pipeline.discardKeptRows();
  return 0;
}

}  // namespace radiosity::cli
