#include "cli/commands.h"
#include "cli/tables.h"

namespace radiosity::cli {

int runFactors(Session& session) {
  OutputSet files = claimOutputs(session);
  checkTableOptions(session.request, files);
  Run run(session, files.path(Format::results));
  std::vector<std::string> surfaces;
  for (const Surface& surface : run.pipeline.scene().surfaces) surfaces.push_back(surface.name);
  checkTables(session, files, surfaces, 0);
  checkTables(session, files, surfaces, run.pipeline.mesh().mesh.size());
  run.pipeline.factors();
  saveResults(session, run.pipeline, files);
  writeTables(session, run.pipeline, files);
  writeCells(session, run.pipeline, files);
  files.commit(session.report, session.progress);
  return 0;
}

}  // namespace radiosity::cli
