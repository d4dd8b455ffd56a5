// The summary of radiative heat exchange.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/field_lines.h"
#include "cli/section.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

namespace {

/// The program warns of heat lost on backs, and of the imbalance, above this share of the radiosity
/// of all surfaces.
constexpr double kWorthWarning = 1e-4;
/// The summary names what a sky at 0 K takes above this share of it.
constexpr double kWorthNaming = 0.01;
/// Scenes all below this (K) are rare, and common where degrees Celsius were given.
constexpr double kColdest = 150;

void surfaceTable(Report& report, const std::vector<SurfaceHeat>& surfaces) {
  std::vector<std::vector<std::string>> rows;
  rows.reserve(surfaces.size());
  for (const SurfaceHeat& s : surfaces) {
    rows.push_back({s.name, numberText(s.area), numberText(s.temperature), numberText(s.lowest),
                    numberText(s.highest), numberText(s.radiosity), numberText(s.irradiance),
                    s.irradiance_error ? numberText(*s.irradiance_error, 2) : "unknown",
                    numberText(s.net_flux), numberText(s.radiated), numberText(s.convected)});
  }
  report.table("surfaces",
               {{"name", "surface", false},
                {"area_m2", "area m^2"},
                {"temperature_K", "mean K"},
                {"lowest_K", "from K"},
                {"highest_K", "to K"},
                {"radiosity_W_per_m2", "J W/m^2"},
                {"irradiance_W_per_m2", "H W/m^2"},
                {"irradiance_error_W_per_m2", "H +- W/m^2"},
                {"net_flux_W_per_m2", "J - H W/m^2"},
                {"radiated_W", "radiated W"},
                {"convected_W", "convected W"}},
               rows);
}

/// The power, W, that leaves all surfaces. Net powers are not a measure for losses: if all surfaces
/// have about one temperature, they are small differences of it.
double givenOff(const std::vector<SurfaceHeat>& surfaces) {
  double sum = 0;
  for (const SurfaceHeat& s : surfaces) sum += s.area * s.radiosity;
  return sum;
}

void balanceFigures(Report& report, const HeatBalance& b, double given_off) {
  const auto watts = [&](const char* key, const char* label, double value) {
    report.number(key, label, value,
                  given_off > 0 ? fmt::format("W  ({:.3g}%)", 100 * value / given_off) : "W");
  };
  report.number("given_off_W", "given off by all surfaces", given_off, "W  (100%)");
  watts("throughput_W", "net powers above 0", b.throughput);
  watts("radiated_W", "radiated by all surfaces, net", b.radiated);
  watts("to_sky_W", "  of it to the sky, net", b.to_sky);
  watts("on_backs_W", "  lost on backs", b.on_backs);
  watts("imbalance_W", "  imbalance", b.imbalance);
  watts("convected_W", "convected to the air", b.convected);
}

/// Reports the accuracy of the form factors and its effect on H.
void factorError(Report& report, const FormFactors& factors) {
  if (factors.method == FormFactorMethod::cut) {
    report.number("irradiance_error", "irradiance off by about", factors.report.cut.error());
    return;
  }
  if (factors.error.empty()) {
    report.text("factor_error", "error of form factors",
                "unknown by " + nameOf(kFactorsFromNames, factors.method) +
                    "; --method exact or rays says it");
    return;
  }
  report.number("factor_error", "error of form factors", factors.report.error_figure);
  report.number("largest_row_error", "  largest figure of a row",
                *std::max_element(factors.error.begin(), factors.error.end()));
}

void warnOfLosses(const HeatBalance& b, FormFactorMethod method, double given_off,
                  std::vector<Note>& notes) {
  const auto worthIt = [&](double watts) { return std::abs(watts) > kWorthWarning * given_off; };
  const auto share = [&](double watts) {
    return fmt::format("{:.3g}% of what all surfaces give off", 100 * std::abs(watts) / given_off);
  };
  if (worthIt(b.on_backs)) {
    notes.push_back(
        {Severity::warning,
         fmt::format("{} W are lost on surfaces seen from behind, which are black and at 0 K, {}: "
                     "flipped? turn them over, --flip NAME, or use --two-sided NAME",
                     numberText(b.on_backs, 3), share(b.on_backs))});
  }
  if (worthIt(b.imbalance)) {
    notes.push_back(
        {Severity::warning,
         fmt::format("{} W are not accounted for, {}: rows of form factors do not sum "
                     "to 1 or lack reciprocity; {}",
                     numberText(b.imbalance, 3), share(b.imbalance), imbalanceCure(method))});
  }
}

/// Notes temperatures that are right in few scenes: a sky that nobody gave, and degrees Celsius.
void noteTemperatures(const HeatBalance& b, double given_off,
                      const std::vector<SurfaceHeat>& surfaces, const HeatOptions& options,
                      std::vector<Note>& notes) {
  if (options.sky_temperature == 0 && b.to_sky > kWorthNaming * given_off) {
    notes.push_back({Severity::info,
                     fmt::format("the sky is at 0 K and takes {:.3g}% of what all surfaces give "
                                 "off; --sky-temperature K gives the surroundings theirs",
                                 100 * b.to_sky / given_off)});
  }
  double highest = options.sky_temperature;
  for (const SurfaceHeat& s : surfaces) highest = std::max(highest, s.highest);
  if (highest > 0 && highest < kColdest) {
    notes.push_back(
        {Severity::info, fmt::format("no temperature is above {} K: were degrees Celsius meant? "
                                     "All are in kelvin",
                                     numberText(highest))});
  }
}

void warnings(Report& report, const HeatSummary& s, FormFactorMethod method, double given_off,
              const std::vector<SurfaceHeat>& surfaces, const HeatOptions& options) {
  std::vector<Note> notes;
  warnOfLosses(s.balance, method, given_off, notes);
  noteTemperatures(s.balance, given_off, surfaces, options, notes);
  if (s.undetermined > 0) {
    notes.push_back(
        {Severity::warning,
         fmt::format(
             "{} no temperature: emissivity 0 and no convection, or no area, so any would do",
             s.undetermined == 1 ? "1 unknown has"
                                 : fmt::format("{} unknowns have", s.undetermined))});
  }
  report.notes(notes);
}

}  // namespace

void summarizeHeat(Report& report, const HeatSolution& heat, const FormFactors& factors,
                   const std::vector<SurfaceHeat>& surfaces, const HeatOptions& options,
                   Detail detail) {
  const HeatSummary& s = heat.summary;
  const double given_off = givenOff(surfaces);
  if (detail == Detail::brief) report.line("", oneLine(s.message));
  {
    const Section section(report, detail, "heat", "Heat exchange");
    FieldLines lines(report);
    lines.after("status", [&] {
      report.count("bands", "bands", std::size_t(heat.bands));
      report.number("sky_temperature_K", "sky", options.sky_temperature, "K");
    });
    lines.after("linear_steps", [&] {
      report.text("linear_solver", "linear systems",
                  s.linear_steps == 0 ? "solved directly"
                                      : fmt::format("GMRES, {} products", s.linear_steps));
    });
    lines.after("balance_residual",
                [&] { report.number("tolerance", "  asked for", options.tolerance); });
    lines.after("seconds", [&] {
      factorError(report, factors);
      balanceFigures(report, s.balance, given_off);
      surfaceTable(report, surfaces);
    });
    s.describe(lines, s);
    usableLine(report, s.usable(), factors);
  }
  warnings(report, s, factors.method, given_off, surfaces, options);
}

}  // namespace radiosity::cli
