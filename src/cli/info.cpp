#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/figure_text.h"
#include "base/made.h"
#include "cli/commands.h"
#include "cli/matrix_commands.h"
#include "cli/summaries.h"
#include "cli/words.h"

namespace radiosity::cli {

namespace {

/// Describes the heat exchange and its conditions.
void describeHeat(Report& report, const Results& stored, const HeatOptions& options) {
  const HeatSolution& heat = made(stored.heat);
  const FormFactors& factors = made(stored.factors);
  summarizeHeat(report, heat, factors, heatBySurface(heat, made(stored.mesh).mesh, factors),
                options, Detail::brief);
  constexpr std::size_t kMostLines = 40;
  std::vector<std::string> lines;
  std::istringstream table(heat.conditions.table);
  for (std::string line; std::getline(table, line);) lines.push_back(line);
  lines.insert(lines.end(), heat.conditions.settings.begin(), heat.conditions.settings.end());
  for (const std::string& group : heat.conditions.groups) lines.push_back("group " + group);
  for (std::size_t k = 0; k < std::min(lines.size(), kMostLines); ++k) {
    report.line(k == 0 ? "conditions" : "", lines[k]);
  }
  if (lines.size() > kMostLines) {
    report.line("", fmt::format("... and {} more lines", countText(lines.size() - kMostLines)));
  }
}

/// Describes the stages in a results file, and the options that made them.
void describeStages(Session& session, const Pipeline& pipeline) {
  const Results& stored = pipeline.stored();
  Report& report = session.report;
  report.section("file", "Stages in the file");
  report.text("version", "written by", "radiosity " + stored.version);
  forEachStage([&](const auto& stage) {
    const auto& found = stored.*stage.value;
    if (found) report.text(stage.group + std::string("_key"), stage.name, found.key);
  });
  if (!stored.mesh) return;
  summarizeMesh(report, *stored.mesh, Detail::brief);
  if (stored.factors) {
    summarizeFactors(report, *stored.factors, stored.mesh->mesh, Detail::brief);
  }
  if (stored.solution) {
    summarizeSolution(report, *stored.solution, made(stored.factors), stored.mesh->mesh,
                      stored.materials && arePhotometric(stored.materials->lights),
                      pipeline.options().solve, Detail::brief);
  }
  if (stored.elements) summarizeElements(report, *stored.elements, made(stored.factors));
  if (stored.gathered) {
    summarizeGathered(report, *stored.gathered, stored.mesh->mesh, pipeline.options().gather,
                      Detail::brief);
  }
  if (stored.heat) {
    describeHeat(report, stored, pipeline.options().heat);
  }
  if (stored.basis) summarizeBasis(report, *stored.basis, Detail::full);
}

int listDevices(Report& report) {
  report.section("devices", "Devices that draw hemicubes");
  const EyeDevices found = eyeDevices();
  if (found.devices.empty()) report.text("problem", "none", oneLine(found.problem));
  std::vector<std::vector<std::string>> rows;
  rows.reserve(found.devices.size());
  for (const EyeDevice& device : found.devices) {
    rows.push_back({device.name, device.hardware ? "hardware" : "software", device.api});
  }
  if (rows.empty()) return 0;
  report.table("devices",
               {{"name", "device", false}, {"kind", "kind", false}, {"api", "by", false}}, rows);
  return 0;
}

}  // namespace

int runInfo(Session& session) {
  if (session.request.devices) return listDevices(session.report);
  if (isMatrixInput(session.request.input)) return describeMatrixFile(session);
  const Run run(session);
  describeScene(session.report, run.pipeline.scene());
  if (run.pipeline.fromResultsFile()) describeStages(session, run.pipeline);
  return 0;
}

}  // namespace radiosity::cli
