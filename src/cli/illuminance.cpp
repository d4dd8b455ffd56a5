#include "radiosity/illuminance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/figure_text.h"
#include "cli/commands.h"
#include "cli/field_lines.h"
#include "cli/measuring_points.h"
#include "cli/show.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/results.h"

namespace radiosity::cli {

namespace {

/// Refuses what cannot be measured or drawn before any work is done.
void checkMeasuring(const Request& request, const OutputSet& files) {
  if (request.points.empty()) {
    throw InputError(
        "illuminance: say where it is measured, with --grid SURFACE:HEIGHT, --plane or --points, "
        "e.g. --grid floor:.8");
  }
  for (const PointsAsked& asked : request.points) checkPoints(asked);
  parseRange(request.range);
  if (!request.range.empty() && !files.has(Format::png)) {
    throw InputError("--range: is of the plan's colours; name one with -o FILE.png");
  }
  const bool any_grid = std::ranges::any_of(request.points, [](const PointsAsked& asked) {
    return asked.kind != PointsAsked::Kind::points;
  });
  if (files.has(Format::png) && !any_grid) {
    throw InputError(files.path(Format::png) +
                     ": a plan is of a grid; add --grid or --plane, or write the points to a .csv");
  }
}

/// A pattern may mean thousands of surfaces; a plan has some 20 MB.
void requireFewPlans(std::span<const MeasuringPoints> sets, const OutputSet& files) {
  constexpr std::ptrdiff_t kMostPlans = 50;
  const auto plans = std::ranges::count_if(sets, [](const auto& set) { return bool(set.grid); });
  if (!files.has(Format::png) || plans <= kMostPlans) return;
  throw InputError(
      fmt::format("{}: there are {} grids, and a picture has {} plans at most; name "
                  "fewer surfaces, or write the points to a .csv",
                  files.path(Format::png), plans, kMostPlans));
}

void requireLuxBands(const Pipeline& pipeline) {
  photometricOf(std::vector<double>(std::size_t(pipeline.bands()), 0.0));
}

PointLightValues measure(Session& session, Pipeline& pipeline,
                         std::span<const MeasuringPoints> sets) {
  const std::vector<Vec3> at = placesOf(sets);
  std::vector<Vec3> normals;
  for (const MeasuringPoints& set : sets) {
    normals.insert(normals.end(), set.normal.begin(), set.normal.end());
  }
  return lightAtPoints(pipeline.mesh().mesh, pipeline.materials(), pipeline.solution().irradiance,
                       pipeline.options().elements, at, normals, pipeline.scene().up,
                       session.request.apply(IlluminanceOptions()), session.progress);
}

void placeLine(Report& report, const std::string& key, const std::string& label, const Vec3& at) {
  const double place[] = {at.x, at.y, at.z};
  report.bands(key, label, place, "m");
}

void summarizeSet(Report& report, const std::string& key, const MeasuringPoints& set,
                  const IlluminanceSummary& s) {
  report.section(key, "Illuminance: " + set.name);
  report.count("points", "points", set.size());
  if (s.inside > 0) {
    report.count("in_bodies", "  in bodies, left out of all figures", s.inside);
  }
  if (set.grid) {
    const double spacing[] = {set.grid->step_u, set.grid->step_v};
    report.bands("spacing_m", "spacing", spacing, "m");
  }
  constexpr double kShown = 1e6;
  const Vec3& n = set.normal.front();
  const double facing[] = {std::round(n.x * kShown) / kShown + 0.0,
                           std::round(n.y * kShown) / kShown + 0.0,
                           std::round(n.z * kShown) / kShown + 0.0};
  if (set.grid || set.size() == 1) report.bands("facing", "facing", facing, "");
  report.number("mean_lx", "mean", s.mean, "lx");
  report.number("lowest_lx", "minimum", s.lowest, "lx");
  placeLine(report, "lowest_at_m", "  at", s.lowest_at);
  report.number("highest_lx", "maximum", s.highest, "lx");
  placeLine(report, "highest_at_m", "  at", s.highest_at);
  report.number("u0", "uniformity U0, minimum over mean", s.overMean());
  report.number("ud", "uniformity Ud, minimum over maximum", s.overHighest());
  report.number("direct_mean_lx", "mean, direct", s.direct, "lx");
  report.number("indirect_mean_lx", "mean, indirect", s.indirect, "lx");
  report.number("cylindrical_mean_lx", "mean, cylindrical", s.cylinder, "lx");
  if (s.daylight_factor > 0) {
    report.number("daylight_factor_mean_percent", "daylight factor, mean", s.daylight_factor, "%");
    report.number("daylight_factor_lowest_percent", "  minimum", s.lowest_daylight_factor, "%");
  }
  if (s.highest > 0) return;
  const Note dark{Severity::warning,
                  set.name + ": no light reaches its points; do they stand outside, or face away?"};
  report.notes({&dark, 1});
}

void summarizeMeasuring(Report& report, const PointLightValues& light, double asked) {
  report.section("measuring", "Measuring");
  report.text("lumens", "lumens", photometricText(light.bands));
  FieldLines lines(report);
  IlluminanceReport::describe(lines, light.report);
  if (light.report.direct == DirectLight::hemispheres) {
    const Note note{Severity::info,
                    "there are too many emitters to aim at: their light is found with the indirect "
                    "light, and counted there"};
    report.notes({&note, 1});
  }
  if (light.report.largest_error > asked) {
    const std::size_t worst = light.report.largest_error_at;
    report.line(
        "note",
        fmt::format("at some points direct or indirect light took all rays that it may, and the "
                    "standard error is above {} %: at one of {} lx it is {} %",
                    numberText(100 * asked, 3), numberText(light.lux(worst, Measured::facing), 3),
                    numberText(100 * light.report.largest_error, 3)));
  }
}

void writeMeasured(std::span<const MeasuringPoints> sets, const PointLightValues& light,
                   const ShownRange& range, OutputSet& files) {
  files.write(Format::illuminance, "illuminance at points",
              [&](const std::string& temporary) { writeIlluminance(temporary, sets, light); });
  files.write(Format::png, "plan, lx", [&](const std::string& temporary) {
    std::vector<Image> plans;
    std::size_t first = 0;
    for (const MeasuringPoints& set : sets) {
      if (set.grid) plans.push_back(illuminancePlan(set, light, first, range.low, range.high));
      first += set.size();
    }
    const std::pair<std::string, std::string> about[] = {{"quantity", "illuminance"},
                                                         {"unit", "lx"}};
    writeImage(temporary, stacked(plans), true, about);
  });
}

}  // namespace

int runIlluminance(Session& session) {
  OutputSet files = claimOutputs(session);
  checkMeasuring(session.request, files);
  Run run(session, files.path(Format::results));
  Pipeline& pipeline = run.pipeline;
  pipeline.options().factors.sources_only |=
      !pipeline.fromResultsFile() && !files.has(Format::results);
  requireLuxBands(pipeline);
  requireLight(session, pipeline);
  const std::vector<MeasuringPoints> sets =
      measuringPoints(session.request.points, pipeline.scene(), session.report);
  requireFewPlans(sets, files);
  if (!files.has(Format::results) && pipeline.onlyAdds()) {
    files.add({session.request.input, Format::results});
  }
  if (pipeline.factors().report.closed) requireWithin(sets, pipeline.mesh().mesh);
  keepFactors(session, pipeline, files);
  const int code = judgeSolution(session, pipeline);
  if (pipeline.solution().summary.status == SolveStatus::singular) {
    throw RunError("no illuminance: the system is singular");
  }
  keepSolution(session, pipeline, files);
  const PointLightValues light = measure(session, pipeline, sets);
  std::size_t first = 0;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    const IlluminanceSummary summary = summaryOf(sets[k], light, first);
    if (summary.points == 0) refuseSet(sets[k], "stand in bodies or behind surfaces");
    const std::string key = k == 0 ? "illuminance" : fmt::format("illuminance_{}", k + 1);
    summarizeSet(session.report, key, sets[k], summary);
    first += sets[k].size();
  }
  summarizeMeasuring(session.report, light, session.request.apply(IlluminanceOptions()).tolerance);
  writeMeasured(sets, light, parseRange(session.request.range), files);
  writeStages(session, pipeline, files);
  files.commit(session.report, session.progress);
  noteUnsaved(session, pipeline, files);
  return code;
}

}  // namespace radiosity::cli
