#include "cli/radiant.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "radiosity/radiant_temperature.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

void temperatureFigures(Report& report, const std::string& key, const std::string& label,
                        const std::vector<double>& temperatures) {
  const auto [low, high] = std::ranges::minmax(temperatures);
  const double mean =
      std::accumulate(temperatures.begin(), temperatures.end(), 0.0) / double(temperatures.size());
  report.number(key + "_mean_K", label + ", mean", mean, "K");
  report.number(key + "_lowest_K", "  from", low, "K");
  report.number(key + "_highest_K", "  to", high, "K");
}

/// `first`: of the points' values among `found`. Points that see no front of a surface stand in
/// bodies.
void summarizeRadiant(Report& report, const std::string& key, const MeasuringPoints& set,
                      const RadiantTemperatures& found, std::size_t first) {
  std::vector<double> standing;
  std::vector<double> seated;
  for (std::size_t k = first; k < first + set.size(); ++k) {
    if (!(found.surfaces[k] > 0)) continue;
    standing.push_back(found.standing[k]);
    seated.push_back(found.seated[k]);
  }
  if (standing.empty()) refuseSet(set, "stand in bodies or behind surfaces");
  report.section(key, "Mean radiant temperature: " + set.name);
  report.count("points", "points", set.size());
  if (standing.size() < set.size()) {
    report.count("in_bodies", "  in bodies, left out of all figures", set.size() - standing.size());
  }
  temperatureFigures(report, "standing", "person standing", standing);
  temperatureFigures(report, "seated", "person seated", seated);
}

}  // namespace

void checkRadiant(const Request& request) {
  for (const PointsAsked& asked : request.points) checkPoints(asked);
  if (request.points.empty() && !request.point_table.empty()) {
    throw InputError(
        "--point-table: say where, with --grid SURFACE:HEIGHT, --plane or --points, e.g. --grid "
        "floor:1.1");
  }
}

void measureRadiant(Session& session, Pipeline& pipeline, std::span<const MeasuringPoints> sets,
                    OutputSet& files) {
  const RadiantTemperatures found =
      radiantTemperatures(pipeline.mesh().mesh, pipeline.heat(), pipeline.options().heat,
                          placesOf(sets), pipeline.scene().up, session.progress);
  std::size_t first = 0;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    summarizeRadiant(session.report, k == 0 ? "radiant" : fmt::format("radiant_{}", k + 1), sets[k],
                     found, first);
    first += sets[k].size();
  }
  files.write(
      Format::point_table, "radiant temperatures at points",
      [&](const std::string& temporary) { writeRadiantTemperatures(temporary, sets, found); });
}

}  // namespace radiosity::cli
