// `heat` on a matrix from a file: conditions name its rows by name or by number.
#include <fmt/format.h>

#include "cli/matrix_commands.h"
#include "cli/summaries.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

void requireOwnOptions(const Request& request, const OutputSet& files) {
  refuseSceneOptions(request);
  if (!request.points.empty() || !request.point_table.empty()) {
    throw InputError(request.input +
                     ": form factors alone have no places; give the scene to measure at points");
  }
  for (const Output& output : files.all()) {
    if (output.format == Format::surface_table || output.format == Format::patch_table) continue;
    throw InputError(output.path + ": heat of a matrix without a scene goes to a .csv");
  }
}

}  // namespace

int heatMatrixFile(Session& session, OutputSet& files) {
  const Request& request = session.request;
  requireOwnOptions(request, files);
  const HeatOptions options = request.apply(HeatOptions());
  const ConditionText text = readConditionText(request.thermal, request.conditions, request.groups);
  const MatrixFile file = readMatrixInput(session);
  const std::vector<std::string>& names = file.factors.names;
  const HeatConditions conditions = readHeatConditions(names, file.emissivity, text);
  validate(conditions, options);
  session.report.notes(conditions.notes);
  const FormFactors factors = reportedFactors(session, file);
  HeatSolution heat = solveHeat(factors, HeatRows{conditions.conditions, conditions.of_surface, {}},
                                options, session.progress);
  heat.conditions = text;
  const std::vector<SurfaceHeat> surfaces = heatByName(heat, names, factors);
  summarizeHeat(session.report, heat, factors, surfaces, options, Detail::full);
  files.write(Format::surface_table, "heat exchange by name",
              [&](const std::string& temporary) { writeHeatTable(temporary, surfaces); });
  files.write(Format::patch_table, "heat exchange by row", [&](const std::string& temporary) {
    writeHeatRows(temporary, heat, names, factors.matrix->area());
  });
  files.commit(session.report, session.progress);
  return exitCode(session, heat.summary.usable(), heat.summary.message);
}

}  // namespace radiosity::cli
