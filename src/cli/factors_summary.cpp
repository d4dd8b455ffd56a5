// The summary of the form factors.
#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
#include "cli/field_lines.h"
#include "cli/section.h"
#include "cli/summaries.h"
#include "cli/words.h"
#include "radiosity/names.h"

namespace radiosity::cli {

namespace {

std::string briefLine(const FormFactors& factors) {
  const FormFactorReport& r = factors.report;
  const std::string scene = r.closed ? "closed scene" : "open scene";
  if (factors.method == FormFactorMethod::exact) {
    const ExactReport& e = r.exact;
    return fmt::format("{}, {} occluded, in {}; {}; {}; error of the matrix about {}",
                       plural(e.unoccluded + e.occluded, "pair", "pairs"), countText(e.occluded),
                       durationText(r.seconds), bytesText(r.matrix_bytes), scene,
                       numberText(r.error_figure, 2));
  }
  if (factors.method == FormFactorMethod::rays) {
    return fmt::format("{} rays in {}; {}; {}; error of the matrix about {}",
                       countText(r.rays.rays), durationText(r.seconds), bytesText(r.matrix_bytes),
                       scene, numberText(r.error_figure, 2));
  }
  if (factors.method == FormFactorMethod::cut) {
    return fmt::format("{} rays in {}; {}; {}; irradiance off by about {}", countText(r.cut.rays),
                       durationText(r.seconds), bytesText(r.matrix_bytes), scene,
                       numberText(r.cut.error(), 2));
  }
  const std::string what = factors.method == FormFactorMethod::hemicube
                               ? plural(r.hemicube.hemicubes, "hemicube", "hemicubes")
                               : nameOf(kFactorsFromNames, factors.method);
  return fmt::format("{} in {}; {}; {}; largest row error {}", what, durationText(r.seconds),
                     bytesText(r.matrix_bytes), scene, numberText(r.largest_row_error, 3));
}

void hemicubeFigures(Report& report, const FormFactorReport& r) {
  FieldLines lines(report);
  lines.after("hemicubes", [&] {
    const auto hemicubes = double(r.hemicube.hemicubes);
    const double per_hemicube = hemicubes > 0 ? r.seconds / hemicubes : 0;
    report.number("microseconds_per_hemicube", "time per hemicube", 1e6 * per_hemicube, "us");
  });
  r.hemicube.describe(lines, r.hemicube);
}

void rayFigures(Report& report, const RayReport& r) {
  FieldLines lines(report);
  lines.after("rays", [&] {
    const double rate = r.seconds_cast > 0 ? 1e-6 * double(r.rays) / r.seconds_cast : 0.0;
    report.number("million_rays_per_second", "  a second, millions", rate);
  });
  r.describe(lines, r);
}

/// The figures of the method that ran.
void methodFigures(Report& report, const FormFactors& factors) {
  const FormFactorReport& r = factors.report;
  if (factors.method == FormFactorMethod::exact) {
    FieldLines lines(report);
    r.exact.describe(lines, r.exact);
  } else if (factors.method == FormFactorMethod::rays) {
    rayFigures(report, r.rays);
  } else if (factors.method == FormFactorMethod::cut) {
    FieldLines lines(report);
    r.cut.describe(lines, r.cut);
  } else if (factors.method == FormFactorMethod::hemicube) {
    hemicubeFigures(report, r);
  }
}

void closureFigures(Report& report, const FormFactorReport& r) {
  const ClosureReport& c = r.closure;
  const bool done = r.symmetrized || r.closure_enforced;
  report.yesNo("closure_enforced", "closure: enforced", done);
  const bool merged = r.symmetrized || r.rays.rounds > 0;
  const char* before = merged ? "closure: rows off by, merged" : "closure: rows off 1 by";
  report.number("closure_residual_before", before, c.largest_residual_before);
  report.number("closure_residual_before_rms", "  root mean square", c.rms_residual_before);
  if (!done) return;
  FieldLines lines(report);
  c.describe(lines, c);
}

void accuracyFigures(Report& report, const FormFactors& factors) {
  const FormFactorReport& r = factors.report;
  if (!factors.error.empty()) {
    report.number("error_figure", "error of F, relL2", r.error_figure);
    std::vector<double> rows = factors.error;
    std::sort(rows.begin(), rows.end());
    const double median = rows.empty() ? 0.0 : rows[rows.size() / 2];
    report.number("row_error_median", "  of a row: median", median);
    report.number("row_error_largest", "  of a row: largest", rows.empty() ? 0.0 : rows.back());
    report.number("largest_row_error", r.closed ? "raw |fronts+backs - 1|" : "rows above 1 by",
                  r.largest_row_error);
  } else {
    report.number("largest_row_error", "|fronts+backs+sky - 1|", r.largest_row_error);
    report.number("reciprocity_residual", "reciprocity residual", r.reciprocity_residual);
    report.yesNo("symmetrized", "symmetrized", r.symmetrized);
  }
  const bool looked_at = r.closure.largest_residual_before > 0;
  if (r.symmetrized || r.closure_enforced || looked_at) closureFigures(report, r);
}

}  // namespace

void summarizeFactors(Report& report, const FormFactors& factors, const PatchMesh& mesh,
                      Detail detail) {
  const FormFactorReport& r = factors.report;
  if (detail == Detail::brief) report.line("", briefLine(factors));
  {
    const Section section(report, detail, "form_factors", "Form factors");
    report.text("method", "method", nameOf(kFactorsFromNames, factors.method));
    FieldLines lines(report);
    lines.after("polygons", [&] { methodFigures(report, factors); });
    lines.after("closed", [&] { accuracyFigures(report, factors); });
    r.describe(lines, r);
    std::vector<std::vector<std::string>> rows;
    for (std::size_t s = 0; s < factors.backs_by_surface.size(); ++s) {
      if (factors.backs_by_surface[s] <= 0) continue;
      rows.push_back({mesh.surface_names[s], numberText(factors.backs_by_surface[s])});
    }
    report.table("backs_by_surface",
                 {{"name", "seen from behind", false}, {"share", "share of the view", true}}, rows);
  }
  if (detail != Detail::none) report.notes(r.notes);
}

}  // namespace radiosity::cli
