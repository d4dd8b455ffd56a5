// The summary of the form factors.
#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
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
  const std::string what = factors.method == FormFactorMethod::hemicube
                               ? plural(r.hemicubes, "hemicube", "hemicubes")
                               : nameOf(kFactorsFromNames, factors.method);
  return fmt::format("{} in {}; {}; {}; largest row error {}", what, durationText(r.seconds),
                     bytesText(r.matrix_bytes), scene, numberText(r.largest_row_error, 3));
}

void hemicubeFigures(Report& report, const FormFactorReport& r) {
  const double per_hemicube = r.hemicubes > 0 ? r.seconds / double(r.hemicubes) : 0;
  report.count("hemicubes", "hemicubes", r.hemicubes);
  report.number("microseconds_per_hemicube", "time per hemicube", 1e6 * per_hemicube, "us");
  report.count("pixels", "pixels resolved", r.pixels);
  report.count("rasterised_polygons", "polygons rasterised", r.rasterised_polygons);
  report.count("skipped_own_plane", "skipped: own plane", r.skipped_own_plane);
  report.count("skipped_horizon", "skipped: below horizon", r.skipped_horizon);
  report.count("skipped_facing_away", "skipped: facing away", r.skipped_facing_away);
  report.count("skipped_face", "skipped: outside a face", r.skipped_face);
  report.count("skipped_hidden", "skipped: hidden", r.skipped_hidden);
  report.count("near_pairs", "near entries made exact", r.near_pairs);
  report.count("capped", "  rows held at 1", r.capped);
}

/// Reports pairs of patches by their treatment, then the work.
void exactFigures(Report& report, const ExactReport& e) {
  report.count("elements", "elements", e.elements);
  report.count("black_elements", "  and of black backs", e.black_elements);
  report.count("facets", "facets", e.facets);
  report.count("occluders", "occluders", e.occluders);
  report.count("solids", "  of them convex solids", e.solids);
  report.count("skipped_hull", "skipped: cannot block", e.skipped_hull);
  report.count("pairs_no_exchange", "pairs without exchange", e.no_exchange);
  report.count("pairs_unoccluded", "pairs unoccluded", e.unoccluded);
  report.count("pairs_hidden", "pairs hidden", e.hidden);
  report.count("pairs_occluded", "pairs occluded", e.occluded);
  report.count("facet_pairs", "facet pairs", e.facet_pairs);
  report.count("skipped_facet_pairs", "skipped: no exchange", e.facet_pairs_no_exchange);
  report.count("skipped_visibility", "skipped: visibility", e.facet_pairs_unoccluded);
  report.count("shaft_tests", "shaft tests", e.shaft_tests);
  report.count("contour", "values by contour", e.contour);
  report.count("lambert", "values by Lambert", e.lambert);
  report.count("product", "values by quadrature", e.product);
  report.count("clipped", "  clipped to front sides", e.clipped);
  report.count("points", "points of occluded pairs", e.points);
  report.count("subdivided", "occluded pairs refined", e.subdivided);
  report.count("evaluated_again", "occluded pairs again in double", e.evaluated_again);
  report.count("rechecked", "evaluated again to check", e.rechecked);
  report.number("recheck_ratio", "  row error / figure, 99%", e.recheck_ratio);
  report.seconds("seconds_prepare", "time: preparing", e.seconds_prepare);
  report.seconds("seconds_visibility", "time: visibility", e.seconds_visibility);
  report.seconds("seconds_unoccluded", "time: closed forms", e.seconds_unoccluded);
  report.seconds("seconds_occluded", "time: occluded pairs", e.seconds_occluded);
  report.seconds("seconds_assembly", "time: storing rows", e.seconds_assembly);
  report.seconds("seconds_finish", "time: finishing", e.seconds_finish);
}

void rayFigures(Report& report, const RayReport& r) {
  const double rate = r.seconds_cast > 0 ? 1e-6 * double(r.rays) / r.seconds_cast : 0.0;
  report.count("triangles", "triangles", r.triangles);
  report.count("rays", "rays", r.rays);
  report.number("million_rays_per_second", "  a second, millions", rate);
  report.count("rays_leaked", "  leaked out, not counted", r.leaked);
  report.count("rounds", "rounds", std::size_t(r.rounds));
  report.count("short_rows", "rows short of the tolerance", r.short_rows);
  if (r.loosened_tolerance) {
    report.number("loosened_tolerance", "  which was loosened to", *r.loosened_tolerance);
  }
  report.seconds("seconds_prepare", "time: preparing", r.seconds_prepare);
  report.seconds("seconds_cast", "time: casting", r.seconds_cast);
  report.seconds("seconds_merge", "time: merging", r.seconds_merge);
  report.seconds("seconds_close", "time: closing rows", r.seconds_close);
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
  report.number("closure_residual", "closure: rows off by, now", c.largest_residual);
  report.count("closure_adjustable", "closure: pairs that could move", c.adjustable);
  report.number("closure_largest_move", "closure: largest move", c.largest_move);
  report.number("closure_relative_move", "closure: move, relL2", c.relative_move);
  report.count("closure_emptied", "closure: moved to 0", c.emptied);
  report.count("closure_fixed_rows", "closure: rows out of reach", c.fixed_rows);
  report.count("closure_iterations", "closure: iterations", std::size_t(c.iterations));
}

void accuracyFigures(Report& report, const FormFactors& factors) {
  const FormFactorReport& r = factors.report;
  report.yesNo("closed", "closed scene", r.closed);
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
    if (!r.method_reason.empty()) report.text("method_reason", "  because", r.method_reason);
    if (r.exact_rows) report.count("exact_rows", "exact rows, of emitters", *r.exact_rows);
    report.count("empty_rows", "empty rows (degenerate)", r.empty_rows);
    report.seconds("seconds", "time", r.seconds);
    report.seconds("seconds_plan", "  of that, planning", r.seconds_plan);
    report.seconds("estimated_seconds", "  the rest estimated before", r.estimated_seconds);
    if (!r.simd_target.empty()) report.text("simd_target", "instruction set", r.simd_target);
    report.bytes("matrix_bytes", "matrix in memory", r.matrix_bytes);
    report.bytes("estimated_bytes", "  estimated before", r.estimated_bytes);
    report.count("polygons", "planar polygons", r.polygons);
    if (factors.method == FormFactorMethod::exact) {
      exactFigures(report, r.exact);
    } else if (factors.method == FormFactorMethod::rays) {
      rayFigures(report, r.rays);
    } else if (factors.method == FormFactorMethod::hemicube) {
      hemicubeFigures(report, r);
    }
    accuracyFigures(report, factors);
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
