// `solve` on a matrix from a file: there is no scene and no mesh, but a table of rows.
#include <fmt/format.h>

#include "cli/matrix_commands.h"
#include "cli/summaries.h"
#include "radiosity/matrix_files.h"

namespace radiosity::cli {

namespace {

void requireOwnOptions(const Request& request, const OutputSet& files) {
  refuseSceneOptions(request);
  for (const Output& output : files.all()) {
    if (output.format == Format::light_csv) continue;
    throw InputError(output.path + ": light of a matrix without a scene goes to a .csv");
  }
  if (request.rows.empty()) {
    throw InputError(request.input +
                     ": what its rows reflect and emit is missing: --rows FILE.csv, with columns "
                     "row or name, reflectance, emission (W/m^2)");
  }
}

}  // namespace

int solveMatrixFile(Session& session, OutputSet& files) {
  const Request& request = session.request;
  requireOwnOptions(request, files);
  const MatrixFile file = readMatrixInput(session);
  const PatchMaterials materials = readRowMaterials(request.rows, file);
  const FormFactors factors = reportedFactors(session, file);
  const SolveOptions options = request.apply(SolveOptions());
  const Solution solution = solve(factors, materials.reflectance, materials.emission,
                                  materials.bands, options, session.progress);
  summarizeSolution(session.report, solution, factors, PatchMesh(), false, options, Detail::full);
  if (!solution.radiosity.empty()) {
    files.write(Format::light_csv, "light by row", [&](const std::string& temporary) {
      writeLightCsv(temporary, file.factors.names, factors.matrix->area(), solution);
    });
  }
  files.commit(session.report, session.progress);
  return exitCode(session, solution.summary.usable(), solution.summary.message);
}

}  // namespace radiosity::cli
