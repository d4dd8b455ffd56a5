// A matrix of form factors as the input of a subcommand.
#include <fmt/format.h>

#include <algorithm>

#include "base/file_name.h"
#include "cli/matrix_commands.h"
#include "cli/summaries.h"
#include "cli/words.h"

namespace radiosity::cli {

bool isMatrixInput(const std::string& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".mtx" || extension == ".vf" || isMatrixFile(path);
}

bool takesMatrixFile(const Request& request) {
  if (isMatrixInput(request.input)) return true;
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

void refuseSceneOptions(const Request& request) {
  const std::pair<const char*, bool> of_scenes[] = {{"--elements", request.elements.has_value()},
                                                    {"--basis", !request.basis.empty()},
                                                    {"--mix", !request.mix.empty()},
                                                    {"--lightmap", !request.lightmap.empty()}};
  const auto refuse = [&](const std::string& name) {
    throw InputError(
        fmt::format("{}: is about a scene, and {} is a matrix; leave it out", name, request.input));
  };
  for (const auto& [name, given] : of_scenes) {
    if (given) refuse(name);
  }
  if (!request.scene.lights.empty()) refuse(request.scene.lights.front().option());
  for (const std::string& given :
       {request.given.firstOf<SceneOverrides>(), request.given.firstOf<SceneOptions>(),
        request.given.firstOf({"patches", "max-edge", "method", "tolerance", "closure"})}) {
    if (!given.empty()) refuse(given);
  }
}

MatrixFile readMatrixInput(Session& session) {
  const Request& request = session.request;
  std::vector<double> areas;
  if (!request.areas.empty()) areas = readAreas(request.areas);
  return readMatrixFile(request.input, session.progress, areas);
}

FormFactors reportedFactors(Session& session, const MatrixFile& file) {
  FormFactors factors = factorsOfFile(file);
  session.report.line("form factors", fmt::format("{}: {}, {}", file.path,
                                                  plural(file.factors.size(), "row", "rows"),
                                                  file.factors.closed ? "closed" : "open"));
  if (!file.has_areas) {
    const Note unknown{
        Severity::warning,
        "areas of the rows are not known: they count as 1 m^2 each in energies; give "
        "--areas FILE"};
    session.report.notes({&unknown, 1});
  }
  session.report.notes(factors.report.notes);
  return factors;
}

int describeMatrixFile(Session& session) {
  refuseSceneOptions(session.request);
  const MatrixFile file = readMatrixInput(session);
  const NamedFactors& rows = file.factors;
  const FormFactors factors = reportedFactors(session, file);
  Report& report = session.report;
  report.section("matrix", "Form factors without a scene");
  report.count("rows", "rows", rows.size());
  report.count("entries", "entries that are not 0", pairsOf(*factors.matrix).nonZeros());
  report.yesNo("closed", "closed", rows.closed);
  if (!factors.fronts.empty()) {
    const auto [least, most] = std::minmax_element(factors.fronts.begin(), factors.fronts.end());
    report.number("row_sum_least", "row sums from", *least);
    report.number("row_sum_largest", "  to", *most);
  }
  report.yesNo("has_areas", "areas", file.has_areas);
  report.yesNo("has_emissivities", "emissivities", !file.emissivity.empty());
  std::vector<std::string> names = rows.names;
  std::erase(names, "");
  std::sort(names.begin(), names.end());
  report.count("names", "names",
               std::size_t(std::unique(names.begin(), names.end()) - names.begin()));
  report.line("next", fmt::format("radiosity solve {0} --rows ROWS.csv, heat {0} --thermal "
                                  "CONDITIONS.csv, compare {0} OTHER.mtx",
                                  file.path));
  return 0;
}

}  // namespace radiosity::cli
