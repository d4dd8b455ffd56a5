#include "cli/summaries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/figure_text.h"
#include "cli/field_lines.h"
#include "cli/section.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

namespace {

// The program warns of light lost on backs above this share of the emitted light.
constexpr double kBacksWorthWarning = 1e-3;

std::string triple(const Vec3& v) {
  return fmt::format("{}, {}, {}", numberText(v.x), numberText(v.y), numberText(v.z));
}

void bands(Report& report, const std::string& key, const std::string& label, const Vec3& v,
           const std::string& unit) {
  const double values[] = {v.x, v.y, v.z};
  report.bands(key, label, values, unit);
}

}  // namespace

void summarizeScene(Report& report, const Scene& scene, const std::string& from) {
  report.line(
      "scene",
      fmt::format("{}: {}, {}, {}, unit {}", from, plural(scene.faceCount(), "face", "faces"),
                  plural(scene.surfaces.size(), "surface", "surfaces"),
                  plural(scene.materials.size(), "material", "materials"), scene.unit));
  const Section section(report, Detail::none, "scene", "Scene");
  report.text("file", "file", scene.file);
  report.text("unit", "unit of the file", scene.unit);
  report.count("faces", "faces", scene.faceCount());
  report.count("vertices", "vertices", scene.vertices.size());
}

namespace {

void describeMaterials(Report& report, const Scene& scene) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(scene.materials.size());
  for (const Material& m : scene.materials) {
    const auto textureName = [&](Index t) { return t == kNone ? "" : scene.textures[t].name; };
    rows.push_back({m.name, triple(m.reflectance), textureName(m.texture), triple(m.emission),
                    triple(m.radiance()), textureName(m.emission_texture),
                    m.two_sided ? "two" : "one"});
  }
  report.table("materials",
               {{"name", "material", false},
                {"reflectance", "reflectance (R, G, B)", false},
                {"texture", "texture", false},
                {"exitance_W_per_m2", "exitance W/m^2", false},
                {"radiance_W_per_m2_sr", "radiance W/m^2/sr", false},
                {"emission_texture", "emission texture", false},
                {"sides", "sides", false}},
               rows);
}

void describeCameras(Report& report, const Scene& scene) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(scene.cameras.size());
  for (const Camera& c : scene.cameras) {
    rows.push_back({c.name, triple(c.eye), triple(c.target), numberText(degrees(c.vertical_fov))});
  }
  report.table("cameras",
               {{"name", "camera", false},
                {"eye_m", "eye (m)", false},
                {"target_m", "target (m)", false},
                {"fov_deg", "fov (deg)", true}},
               rows);
}

/// "W/m^2/sr" -> "W_per_m2_sr", for keys.
std::string wordOfUnit(std::string unit) {
  std::erase(unit, '^');
  if (const std::size_t per = unit.find('/'); per != std::string::npos) {
    unit.replace(per, 1, "_per_");
  }
  std::ranges::replace(unit, '/', '_');
  return unit;
}

/// Lights without a surface that stand somewhere.
void describeLamps(Report& report, const Scene& scene) {
  std::vector<std::vector<std::string>> rows;
  for (const Light& light : scene.lights) {
    if (light.isUniform()) continue;
    std::string watts;
    for (std::size_t b = 0; b < light.strength.size(); ++b) {
      const std::optional<double> power = light.power(b);
      if (power) watts += fmt::format("{}{:.5g}", b == 0 ? "" : ", ", *power);
    }
    const LightRay ray = light.ray(Vec3(0.0), 0, 0);
    const Vec3 where = light.place().value_or(ray.toward);
    const Vec3 strength(light.strength[0], light.strength[1], light.strength[2]);
    rows.push_back(
        {light.name, light.traits().word,
         fmt::format("{} {}", triple(strength), light.traits().unit),
         fmt::format("{} {}", triple(kLumensPerWatt * strength), light.traits().photometric),
         light.isAllRound() ? light.traits().from
                            : fmt::format("{} {}", light.place() ? "at" : "towards", triple(where)),
         watts, light.fileName()});
  }
  if (rows.empty()) return;
  report.section("scene", "Lights");
  report.table("lights",
               {{"name", "light", false},
                {"kind", "kind", false},
                {"strength", "strength (R, G, B)", false},
                {"photometric", "in cd, lx or lm", false},
                {"stands", "stands", false},
                {"power_W", "power W", false},
                {"file", "file", false}},
               rows);
}

}  // namespace

void describeScene(Report& report, const Scene& scene) {
  const SceneInfo info = inspectScene(scene);
  report.section("scene", "Scene");
  report.text("file", "file", scene.file);
  report.text("unit", "unit of the file", scene.unit);
  report.count("faces", "faces", scene.faceCount());
  report.count("triangles", "triangles", info.triangles);
  report.count("vertices", "vertices", scene.vertices.size());
  report.count("textures", "textures", scene.textures.size());
  bands(report, "lower_m", "lower corner", info.lower, "m");
  bands(report, "upper_m", "upper corner", info.upper, "m");
  bands(report, "extent_m", "extent", info.upper - info.lower, "m");
  report.text("up", "up", nameOf(kUpNames, scene.up));
  report.yesNo("watertight", "watertight", info.watertight);
  report.count("open_edges", "open edges", info.open_edges);
  bands(report, "emitted_power_W", "emitted power (R G B)", info.emitted_power, "W");
  std::vector<std::vector<std::string>> rows;
  std::size_t emitters = 0;
  for (const SurfaceInfo& s : info.surfaces) {
    const bool emits = s.emitted_power != Vec3(0.0);
    emitters += emits ? 1 : 0;
    rows.push_back({s.name, s.material, countText(s.faces), numberText(s.area),
                    emits ? triple(s.emitted_power) : ""});
  }
  report.count("emitters", "emitting surfaces", emitters);
  for (const Light& light : scene.lights) {
    if (!light.isUniform()) continue;
    const std::string unit = light.traits().unit;
    report.bands(light.name + "_" + wordOfUnit(unit), light.name + " (R G B)", light.strength,
                 unit);
  }
  describeLamps(report, scene);
  report.section("scene", "Surfaces");
  report.table("surfaces",
               {{"name", "surface", false},
                {"material", "material", false},
                {"faces", "faces", true},
                {"area_m2", "area m^2", true},
                {"emitted_power_W", "emitted W (R, G, B)", false}},
               rows);
  report.section("scene", "Materials");
  describeMaterials(report, scene);
  if (!scene.cameras.empty()) {
    report.section("scene", "Cameras");
    describeCameras(report, scene);
  }
  report.section("scene", info.problems.empty() && scene.notes.empty() ? "Nothing looks wrong."
                                                                       : "What to know:");
  report.notes(scene.notes);
  report.notes(info.problems);
}

namespace {

void surfaceAreas(Report& report, const MeshReport& r) {
  std::vector<std::vector<std::string>> rows;
  bool dropped_any = false;
  for (const SurfaceAreas& s : r.surfaces) {
    dropped_any = dropped_any || s.buried > 0 || s.overlapped > 0 || s.degenerate > 0;
    rows.push_back({s.name, numberText(s.given), numberText(s.kept), numberText(s.buried),
                    numberText(s.overlapped), numberText(s.degenerate)});
  }
  const bool was_muted = report.muted();
  if (!dropped_any) report.mute(true);
  report.table("surfaces",
               {{"name", "surface", false},
                {"given_m2", "given m^2", true},
                {"kept_m2", "kept m^2", true},
                {"buried_m2", "buried m^2", true},
                {"overlapped_m2", "overlapped m^2", true},
                {"degenerate_m2", "degenerate m^2", true}},
               rows);
  report.mute(was_muted);
  if (!dropped_any) report.text("dropped_area", "area dropped", "none");
}

}  // namespace

void summarizeMesh(Report& report, const MeshResult& result, Detail detail) {
  const MeshReport& r = result.report;
  const PatchMesh& mesh = result.mesh;
  const double area = std::accumulate(mesh.area.begin(), mesh.area.end(), 0.0);
  if (detail == Detail::brief) {
    const std::size_t others = mesh.size() - r.quads - r.triangles;
    report.line(
        "", fmt::format("{} ({}, {}{}) on {}; T-junctions {}; smallest angle {} deg",
                        plural(mesh.size(), "patch", "patches"), plural(r.quads, "quad", "quads"),
                        plural(r.triangles, "triangle", "triangles"),
                        others > 0 ? fmt::format(", {} of more corners", others) : "",
                        plural(r.polygons, "polygon", "polygons"), r.t_junctions,
                        numberText(r.smallest_angle, 3)));
  }
  {
    const Section section(report, detail, "mesh", "Mesh");
    report.count("patches", "patches", mesh.size());
    report.count("fronts", "of them fronts", mesh.frontCount());
    FieldLines lines(report);
    lines.after("polygons", [&] { report.number("area_m2", "area of all patches", area, "m^2"); });
    r.describe(lines, r);
    surfaceAreas(report, r);
  }
  if (detail != Detail::none) report.notes(r.notes);
}

namespace {

double sum(const std::vector<double>& bands) {
  return std::accumulate(bands.begin(), bands.end(), 0.0);
}

/// Incoming power: emitted, and from lights without a surface.
double incoming(const EnergyAccount& e) { return sum(e.emitted) + sum(e.from_sky); }

/// A part as a share of the incoming power, which is easier to judge than watts.
std::string shareOf(const std::vector<double>& part, const EnergyAccount& e) {
  return incoming(e) > 0 ? fmt::format("W  ({:.3g}%)", 100 * sum(part) / incoming(e)) : "W";
}

void energyFigures(Report& report, const EnergyAccount& e) {
  report.bands("emitted_W", fmt::format("emitted ({})", bandsText(int(e.emitted.size()))),
               e.emitted, "W");
  report.bands("from_sky_W", "from the sky and lamps", e.from_sky, "W");
  report.bands("absorbed_W", "absorbed", e.absorbed, shareOf(e.absorbed, e));
  report.bands("to_sky_W", "left to the sky", e.to_sky, shareOf(e.to_sky, e));
  report.bands("on_backs_W", "lost on backs", e.on_backs, shareOf(e.on_backs, e));
  report.bands("imbalance_W", "imbalance", e.imbalance, shareOf(e.imbalance, e));
}

/// The same in lumens, as far as the eye's light goes.
void photometricFigures(Report& report, const EnergyAccount& e) {
  report.number("incoming_lm", "coming in, as light",
                photometricOf(e.emitted) + photometricOf(e.from_sky), "lm");
  report.number("absorbed_lm", "  absorbed", photometricOf(e.absorbed), "lm");
  report.number("to_sky_lm", "  left to the sky", photometricOf(e.to_sky), "lm");
}

/// Warns of surfaces whose backs take more than 0.1% of the light.
void warnOfBacks(Report& report, const EnergyAccount& e,
                 const std::vector<double>& backs_by_surface, const PatchMesh& mesh) {
  const double lost = sum(e.on_backs);
  if (!(incoming(e) > 0) || lost <= kBacksWorthWarning * incoming(e)) return;
  std::vector<std::pair<double, std::string>> seen;
  for (std::size_t s = 0; s < backs_by_surface.size(); ++s) {
    if (backs_by_surface[s] > 0) {
      seen.emplace_back(backs_by_surface[s], mesh.surface_names[s]);
    }
  }
  std::sort(seen.rbegin(), seen.rend());
  std::string names;
  for (std::size_t k = 0; k < std::min<std::size_t>(seen.size(), 5); ++k) {
    names += (k > 0 ? ", " : "") + seen[k].second;
  }
  if (seen.size() > 5) names += fmt::format(" and {} more", seen.size() - 5);
  const Note note{Severity::warning,
                  fmt::format("{:.2g}% of the light is lost on surfaces seen from behind: flipped? "
                              "({}); turn them over, --flip NAME, or use --two-sided NAME",
                              100 * lost / incoming(e), names)};
  report.notes({&note, 1});
}

}  // namespace

void usableLine(Report& report, bool usable, const FormFactors& factors) {
  const std::string condition = factors.condition();
  if (!usable || condition.empty()) return report.yesNo("usable", "usable", usable);
  report.text("usable", "usable", condition);
}

void boundLine(Report& report, const std::optional<double>& bound) {
  if (bound) {
    report.number("error_bound_W_per_m2", "|B - B*| is at most", *bound, "W/m^2");
  } else {
    report.text("error_bound_W_per_m2", "|B - B*| is at most", "no certificate");
  }
}

namespace {

void solverLines(Report& report, const SolveSummary& s, const SolveOptions& options) {
  // Older files do not have the solver that ran: it was the one asked for.
  const Solver ran = s.solver == Solver::automatic ? options.solver : s.solver;
  report.text("solver", "solver", nameOf(kSolverNames, ran));
  report.text("solver_asked_for", "  asked for", nameOf(kSolverNames, options.solver));
}

}  // namespace

void summarizeSolution(Report& report, const Solution& solution, const FormFactors& factors,
                       const PatchMesh& mesh, bool photometric, const SolveOptions& options,
                       Detail detail) {
  const SolveSummary& s = solution.summary;
  if (detail == Detail::brief) report.line("", oneLine(s.message));
  {
    const Section section(report, detail, "solution", "Solution");
    FieldLines lines(report);
    lines.after("solver", [&] { solverLines(report, s, options); });
    lines.after("skipped", [&] { s.skipped.describe(lines, s.skipped); });
    lines.after("residual", [&] { report.number("tolerance", "  asked for", options.tolerance); });
    lines.after("error_bound", [&] { boundLine(report, s.error_bound); });
    lines.after("residual_history", [&] { report.series("residual_history", s.residual_history); });
    lines.after("energy", [&] {
      if (s.energy.emitted.empty()) return;  // singular
      energyFigures(report, s.energy);
      if (photometric && isPhotometric(solution.bands)) photometricFigures(report, s.energy);
    });
    s.describe(lines, s);
    usableLine(report, s.usable(), factors);
  }
  warnOfBacks(report, s.energy, factors.backs_by_surface, mesh);
}

namespace {

void passTable(Report& report, const std::vector<GatherPass>& passes) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    const GatherPass& pass = passes[k];
    const double whole = incoming(pass.energy);
    const auto share = [&](double part) {
      return fmt::format("{:.4g}", whole > 0 ? 100 * part / whole : 0.0);
    };
    rows.push_back({fmt::format("{}", k + 1), fmt::format("{:.3g}", pass.seconds),
                    fmt::format("{:.3e}", pass.change),
                    pass.bound ? fmt::format("{:.3e}", *pass.bound) : "none",
                    share(sum(pass.energy.absorbed)),
                    share(sum(pass.energy.to_sky) + sum(pass.energy.on_backs)),
                    share(sum(pass.in_flight)), share(sum(pass.energy.imbalance))});
  }
  report.table("passes",
               {{"pass", "pass"},
                {"seconds", "time s"},
                {"change", "change / max E"},
                {"bound_W_per_m2", "left W/m^2 at most"},
                {"absorbed_percent", "absorbed %"},
                {"lost_percent", "to sky and backs %"},
                {"in_flight_percent", "in flight %"},
                {"imbalance_percent", "imbalance %"}},
               rows);
}

void gatherFigures(Report& report, const Gathered& gathered, const GatherOptions& options,
                   Detail detail) {
  const GatherSummary& s = gathered.summary;
  const Section section(report, detail, "gather", "Gather");
  report.text("at", "at", nameOf(kGatherAtNames, gathered.at));
  report.count("eyes", "eyes", gathered.area.size());
  FieldLines lines(report);
  lines.after("hemicubes", [&] {
    report.count("resolution", "pixels along an edge", std::size_t(options.resolution));
    report.count("pass_count", "passes", s.passes.size());
  });
  lines.after("closed", [&] {
    if (!s.passes.empty()) energyFigures(report, s.passes.back().energy);
    passTable(report, s.passes);
  });
  s.describe(lines, s);
  report.yesNo("usable", "usable", s.usable());
}

}  // namespace

void summarizeGathered(Report& report, const Gathered& gathered, const PatchMesh& mesh,
                       const GatherOptions& options, Detail detail) {
  const GatherSummary& s = gathered.summary;
  if (detail == Detail::brief) report.line("", oneLine(s.message));
  gatherFigures(report, gathered, options, detail);
  report.notes(s.notes);
  if (s.passes.empty()) return;
  const EnergyAccount& energy = s.passes.back().energy;
  warnOfBacks(report, energy, gathered.backs_by_surface, mesh);
}

}  // namespace radiosity::cli
