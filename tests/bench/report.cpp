#include "report.h"

#include <fmt/format.h>
#include <fmt/os.h>

#include <cstdio>

namespace radiosity::bench {
namespace {

constexpr double kMebibyte = 1024.0 * 1024.0;

std::string settingText(const Measurement& m) {
  return m.value < 1 ? fmt::format("{:.0e}", m.value) : fmt::format("{:.0f}", m.value);
}

/// "1e-03 1e-04"
std::string settingsText(const std::vector<double>& tolerances) {
  std::string text;
  for (const double tolerance : tolerances) {
    text += fmt::format("{}{:.0e}", text.empty() ? "" : " ", tolerance);
  }
  return text;
}

}  // namespace

void printCurveHead(const SceneCurves& curves) {
  fmt::print(
      "  error of F over {} rows, of B against {}; one thread, processor time\n"
      "  own est.: error figure of the matrix; rows whose error stays below theirs; figure / "
      "error\n",
      curves.truth_rows, curves.radiosity_reference);
  fmt::print("  {:<15} {:>9} | {:>9} {:>9} | {:>8} {:>8} {:>8} | {:>8} {:>6} {:>6} | {:>8} | {}\n",
             "method", "setting", "seconds", "wall", "relL2(F)", "largest", "relL2(B)", "own est.",
             "rows", "median", "MiB", "pairs: unoccluded, hidden, occluded");
}

void printMeasurement(const Measurement& m) {
  fmt::print("  {:<15} {:>9} | {:>9.4f} {:>9.4f} | {:>8.1e} {:>8.1e} {:>8} | ", m.method,
             settingText(m), m.seconds.processor(), m.seconds.wall, m.factors.relative_l2,
             m.factors.largest, m.radiosity ? fmt::format("{:.1e}", *m.radiosity) : "-");
  if (m.own) {
    fmt::print("{:>8.1e} {:>5.0f}% {:>6.1f} | ", m.own->matrix, 100 * m.own->rows_covered,
               m.own->median_ratio);
  } else {
    fmt::print("{:>8} {:>6} {:>6} | ", "-", "-", "-");
  }
  fmt::print("{:>8.2f} |", double(m.bytes) / kMebibyte);
  if (m.exact.elements > 0) {
    fmt::print(" {} {} {}", m.exact.unoccluded, m.exact.hidden, m.exact.occluded);
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void printLeftOut(const SceneCurves& curves) {
  if (curves.left_out.empty()) return;
  fmt::print("  {:<15} {} left out: the run before took more than {:.0f} s\n", "exact",
             settingsText(curves.left_out), kMostSeconds);
  std::fflush(stdout);
}

void printSummary(const Summary& summary) {
  if (!summary.comparisons.empty()) {
    fmt::print(
        "\nExact against rays: the time of the cheapest exact setting that stays below an error, "
        "and\n"
        "the time at which the law through the last three points of the ray-cast curve gets there\n"
        "(extra: extrapolated beyond its dearest point)\n");
    fmt::print("  {:<20} {:>7} {:>8} | {:>9} {:>9} {:>8} | {:<15} {:>12} {:>6} {:>6} | {:>9}\n",
               "scene", "patches", "error", "exact, s", "tolerance", "reached", "curve", "seconds",
               "slope", "", "ratio");
    for (const RayComparison& c : summary.comparisons) {
      fmt::print(
          "  {:<20} {:>7} {:>8.0e} | {:>9.3f} {:>9.0e} {:>8.1e} | {:<15} {:>12.1f} {:>6.2f} {:>6} "
          "| "
          "{:>8.0f}x\n",
          c.scene, c.patches, c.error, c.exact_seconds, c.exact_tolerance, c.exact_error, c.curve,
          c.ray_seconds, c.rays.slope, c.extrapolated ? "extra" : "", c.ratio());
    }
  }
  if (summary.growth) {
    const Growth& g = *summary.growth;
    fmt::print("\nGrowth: {} patches in {:.3f} s, {} in {:.3f} s: N^{:.2f}\n", g.from,
               g.from_seconds, g.to, g.to_seconds, g.exponent);
  }
  if (summary.two_cores) {
    const TwoCores& t = *summary.two_cores;
    fmt::print(
        "Two threads against one, {} patches: {:.3f} s and {:.3f} s of wall-clock time, {:.2f}x "
        "({:.2f} processors kept busy)\n",
        t.patches, t.one, t.two, t.one / t.two, t.busy);
  }
  if (summary.whole_run) {
    const WholeRun& r = *summary.whole_run;
    if (r.exit_code != 0) {
      fmt::print("The program on the cluttered scene: FAILED, exit code {}\n", r.exit_code);
    } else {
      fmt::print(
          "The program on the cluttered scene, {} patches, 2 threads, reading, meshing and writing "
          "included:\n  {:.1f} s ({:.1f} s processor), peak memory {:.0f} MiB, file {:.0f} MiB\n",
          r.patches, r.wall, r.processor, r.peak_mebibytes, double(r.file_bytes) / kMebibyte);
    }
  }
}

void writeCsv(const std::string& path, const std::vector<SceneCurves>& curves) {
  auto out = fmt::output_file(path);
  out.print(
      "scene,patches,polygons,truth_rows,method,setting,value,user_s,system_s,wall_s,runs,"
      "relative_l2_F,largest_F,relative_l2_B,B_reference,error_figure,rows_covered,median_figure_"
      "over_error,largest_row_error,bytes,"
      "pairs_no_exchange,pairs_unoccluded,pairs_hidden,pairs_occluded,exact_left_out\n");
  for (const SceneCurves& c : curves) {
    for (const Measurement& m : c.measurements) {
      out.print("{},{},{},{},{},{},{:g},{:.6f},{:.6f},{:.6f},{},{:.6e},{:.6e},{},{},", c.scene,
                c.patches, c.polygons, c.truth_rows, m.method, m.setting, m.value, m.seconds.user,
                m.seconds.system, m.seconds.wall, m.runs, m.factors.relative_l2, m.factors.largest,
                m.radiosity ? fmt::format("{:.6e}", *m.radiosity) : "", c.radiosity_reference);
      if (m.own) {
        out.print("{:.6e},{:.4f},{:.3f},", m.own->matrix, m.own->rows_covered, m.own->median_ratio);
      } else {
        out.print(",,,");
      }
      out.print("{:.3e},{},", m.largest_row_error, m.bytes);
      if (m.exact.elements > 0) {
        out.print("{},{},{},{},", m.exact.no_exchange, m.exact.unoccluded, m.exact.hidden,
                  m.exact.occluded);
      } else {
        out.print(",,,,");
      }
      out.print("{}\n", settingsText(c.left_out));
    }
  }
}

void writeComparisonsCsv(const std::string& path, const std::vector<RayComparison>& comparisons) {
  auto out = fmt::output_file(path);
  out.print(
      "scene,patches,curve,error,exact_s,exact_tolerance,exact_error,rays_s,ray_factor,ray_slope,"
      "extrapolated,ratio\n");
  for (const RayComparison& c : comparisons) {
    out.print("{},{},{},{:g},{:.6f},{:g},{:.6e},{:.6e},{:.6e},{:.4f},{},{:.2f}\n", c.scene,
              c.patches, c.curve, c.error, c.exact_seconds, c.exact_tolerance, c.exact_error,
              c.ray_seconds, c.rays.factor, c.rays.slope, c.extrapolated ? 1 : 0, c.ratio());
  }
}

}  // namespace radiosity::bench
