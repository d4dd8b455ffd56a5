// solve of a matrix from elsewhere: no scene, no mesh, a table of rows.
#include <fmt/format.h>

#include "cli/matrix_commands.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/matrix_files.h"

namespace radiosity::cli {

namespace {

void requireOwnOptions(const Request& request, const OutputSet& files) {
  const std::pair<const char*, bool> of_scenes[] = {
      {"--set", !request.scene.set.empty()},
      {"--materials", !request.scene.materials_file.empty()},
      {"--one-sided", !request.scene.one_sided.empty()},
      {"--two-sided", !request.scene.two_sided.empty()},
      {"--sky", request.scene.sky.has_value()},
      {"--patches", request.patches.has_value()},
      {"--max-edge", request.max_edge.has_value()},
      {"--method", request.method.has_value()},
      {"--tolerance", request.tolerance.has_value()},
      {"--closure", request.closure.has_value()},
      {"--elements", request.elements.has_value()},
      {"--basis", !request.basis.empty()},
      {"--mix", !request.mix.empty()},
      {"--lightmap", !request.lightmap.empty()}};
  for (const auto& [name, given] : of_scenes) {
    if (!given) continue;
    throw InputError(
        fmt::format("{}: is about a scene, and {} is a matrix; leave it out", name, request.input));
  }
  if (!request.reading_options.empty()) {
    throw InputError(fmt::format("{}: is about a scene, and {} is a matrix; leave it out",
                                 request.reading_options.front(), request.input));
  }
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

void noteRows(Report& report, const MatrixFile& file, const FormFactors& factors) {
  std::vector<Note> notes;
  if (!file.has_areas) {
    notes.push_back({Severity::warning,
                     "areas of the rows are not known: they count as 1 m^2 each in energies; give "
                     "--areas FILE"});
  }
  report.notes(notes);
  report.notes(factors.report.notes);
}

}  // namespace

bool solvesMatrixFile(const Request& request) {
  if (isMatrixFile(request.input)) return true;
  for (const auto& [name, given] :
       {std::pair("--rows", !request.rows.empty()), std::pair("--areas", !request.areas.empty())}) {
    if (!given) continue;
    throw InputError(
        fmt::format("{}: is about a matrix from a file (.mtx, .vf), and {} is none; "
                    "leave it out",
                    name, request.input));
  }
  return false;
}

int solveMatrixFile(Session& session, OutputSet& files) {
  const Request& request = session.request;
  requireOwnOptions(request, files);
  std::vector<double> areas;
  if (!request.areas.empty()) areas = readAreas(request.areas);
  const MatrixFile file = readMatrixFile(request.input, session.progress, areas);
  const PatchMaterials materials = readRowMaterials(request.rows, file);
  const FormFactors factors = factorsOfFile(file);
  session.report.line("form factors", fmt::format("{}: {}, {}", file.path,
                                                  plural(file.factors.size(), "row", "rows"),
                                                  file.factors.closed ? "closed" : "open"));
  noteRows(session.report, file, factors);
  const SolveOptions options = request.apply(SolveOptions());
  const Solution solution = solve(factors, materials.reflectance, materials.emission,
                                  materials.bands, options, session.progress);
  summarizeSolution(session.report, solution, factors, PatchMesh(), options, Detail::full);
  if (!solution.radiosity.empty()) {
    files.write(Format::light_csv, "light by row", [&](const std::string& temporary) {
      writeLightCsv(temporary, file.factors.names, factors.matrix.area(), solution);
    });
  }
  files.commit(session.report, session.progress);
  if (solution.summary.usable()) return 0;
  const Note unusable{Severity::loud, solution.summary.message};
  session.report.notes({&unusable, 1});
  return 1;
}

}  // namespace radiosity::cli
